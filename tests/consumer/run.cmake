# Installs the build into an empty folder, copies the consumer beside it, builds it there from the installed package alone, and runs it.
#
#   cmake -D BUILD_DIR=... -D GENERATOR=... -D COMPILER=... [-D SANITIZE=address,...] -P run.cmake
set(place ${BUILD_DIR}/consumer)
file(REMOVE_RECURSE ${place})
file(COPY ${CMAKE_CURRENT_LIST_DIR}/CMakeLists.txt ${CMAKE_CURRENT_LIST_DIR}/main.cpp DESTINATION ${place}/source)

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${place}/installed)

# The package must stand alone: none of its files may lead back to the build, nor through it to the sources.
file(GLOB_RECURSE package ${place}/installed/*.cmake)
foreach(file IN LISTS package)
  file(READ ${file} text)
  string(FIND "${text}" "${BUILD_DIR}" at)
  if(NOT at EQUAL -1)
    message(FATAL_ERROR "${file} names ${BUILD_DIR}")
  endif()
endforeach()

set(flags "")
if(SANITIZE)
  set(flags -fsanitize=${SANITIZE})
endif()
run(${CMAKE_COMMAND} -S ${place}/source -B ${place}/build -G ${GENERATOR} -D CMAKE_BUILD_TYPE=Release -D CMAKE_CXX_COMPILER=${COMPILER}
  -D CMAKE_CXX_FLAGS=${flags} -D CMAKE_PREFIX_PATH=${place}/installed)
run(${CMAKE_COMMAND} --build ${place}/build)
run(${place}/build/consumer)
