# How a folder becomes a target, and the targets a package.
#
#   tenon_library(core SOURCES a.cpp ... PUBLIC Eigen ... PRIVATE fmt::fmt)    makes tenon::core from one folder
#   tenon_embed(problems FUNCTION f FILES a.toml ...)                         f() in tenon::problems gives these files, as text
#   tenon_install_package()                                                  installs targets, headers, scenarios and find_package(tenon)

find_package(Eigen3 3.4 QUIET NO_MODULE)
if(NOT TARGET Eigen3::Eigen)
  find_path(EIGEN3_INCLUDE_DIR Eigen/Core PATH_SUFFIXES eigen3 REQUIRED)
  add_library(Eigen3::Eigen INTERFACE IMPORTED)
  set_target_properties(Eigen3::Eigen PROPERTIES INTERFACE_INCLUDE_DIRECTORIES ${EIGEN3_INCLUDE_DIR})
endif()

# Sources say <tenon/core/x.hpp>, here as after installation: the tree itself stands under that name in the build.
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/include)
file(CREATE_LINK ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR}/include/tenon SYMBOLIC)

# Flags of our own code, never of those who link to it.
add_library(tenon-flags INTERFACE)
target_compile_options(tenon-flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -ffp-contract=off)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(tenon-flags INTERFACE -Wno-restrict)  # gcc bug 105651: wrong for "text" + std::string
endif()
if(TENON_ARCH)
  target_compile_options(tenon-flags INTERFACE -march=${TENON_ARCH})
endif()
if(TENON_WARNINGS_AS_ERRORS)
  target_compile_options(tenon-flags INTERFACE -Werror)
endif()
if(TENON_SANITIZE)
  target_compile_options(tenon-flags INTERFACE -fsanitize=${TENON_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(tenon-flags INTERFACE -fsanitize=${TENON_SANITIZE})
endif()

function(tenon_library name)
  cmake_parse_arguments(LIB "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(tenon-${name} STATIC ${LIB_SOURCES})
  add_library(tenon::${name} ALIAS tenon-${name})
  set_target_properties(tenon-${name} PROPERTIES EXPORT_NAME ${name})
  target_compile_features(tenon-${name} PUBLIC cxx_std_20)
  target_include_directories(tenon-${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(tenon-${name} PUBLIC ${LIB_PUBLIC} PRIVATE ${LIB_PRIVATE} $<BUILD_INTERFACE:tenon-flags>)
  install(TARGETS tenon-${name} EXPORT tenonTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
endfunction()

# The text of files as a function `std::vector<tenon::EmbeddedFile> tenon::f()` of a folder's target, so that a binary needs no folder of data.
function(tenon_embed name)
  cmake_parse_arguments(EMBED "" "FUNCTION" "FILES" ${ARGN})
  set(entries "")
  foreach(file ${EMBED_FILES})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${file})
    file(READ ${file} text)
    get_filename_component(stem ${file} NAME_WE)
    string(APPEND entries "    {\"${stem}\", R\"EMBEDDED(${text})EMBEDDED\"},\n")
  endforeach()
  set(EMBED_ENTRIES "${entries}")  # quoted: a text may hold semicolons
  configure_file(${PROJECT_SOURCE_DIR}/core/cmake/embedded.cpp.in ${CMAKE_CURRENT_BINARY_DIR}/${EMBED_FUNCTION}.cpp @ONLY)
  target_sources(tenon-${name} PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/${EMBED_FUNCTION}.cpp)
endfunction()

function(tenon_install_package)
  include(CMakePackageConfigHelpers)
  set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/tenon)
  install(DIRECTORY core mpc problems solvers DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tenon FILES_MATCHING PATTERN "*.hpp")
  install(DIRECTORY problems/ DESTINATION ${CMAKE_INSTALL_DATADIR}/tenon FILES_MATCHING PATTERN "*.toml" PATTERN "*.csv")
  install(EXPORT tenonTargets NAMESPACE tenon:: DESTINATION ${package_dir})
  configure_package_config_file(${PROJECT_SOURCE_DIR}/core/cmake/tenonConfig.cmake.in
    ${PROJECT_BINARY_DIR}/tenonConfig.cmake INSTALL_DESTINATION ${package_dir})
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/tenonConfigVersion.cmake COMPATIBILITY SameMinorVersion)
  install(FILES ${PROJECT_BINARY_DIR}/tenonConfig.cmake ${PROJECT_BINARY_DIR}/tenonConfigVersion.cmake DESTINATION ${package_dir})
endfunction()
