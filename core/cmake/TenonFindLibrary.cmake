# A library of the system that brings no CMake package: by pkg-config where it is known there, else where headers and libraries usually lie.
#
#   tenon_find_library(IPOPT ipopt HEADER IpTNLP.hpp PATH_SUFFIXES coin)       sets IPOPT_FOUND, IPOPT_INCLUDE_DIR, IPOPT_LIBRARY
#
# The result is a path, so that an installed tenon names no target that its users would have to find first.
find_package(PkgConfig QUIET)

function(tenon_find_library prefix name)
  cmake_parse_arguments(ARG "" "HEADER" "PATH_SUFFIXES" ${ARGN})
  if(PkgConfig_FOUND)
    pkg_check_modules(PC_${prefix} QUIET ${name})
  endif()
  find_path(${prefix}_INCLUDE_DIR ${ARG_HEADER} HINTS ${PC_${prefix}_INCLUDE_DIRS} PATH_SUFFIXES ${ARG_PATH_SUFFIXES})
  find_library(${prefix}_LIBRARY ${name} HINTS ${PC_${prefix}_LIBRARY_DIRS})
  mark_as_advanced(${prefix}_INCLUDE_DIR ${prefix}_LIBRARY)
  if(${prefix}_INCLUDE_DIR AND ${prefix}_LIBRARY)
    set(${prefix}_FOUND TRUE PARENT_SCOPE)
  else()
    set(${prefix}_FOUND FALSE PARENT_SCOPE)
  endif()
endfunction()
