# Installs BUILD to a prefix below SCRATCH, then configures, builds and runs CONSUMER against it, and
# asks the installed program for its version. Any failure ends the script with an error.
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${SCRATCH})
set(prefix ${SCRATCH}/prefix)

function(must_succeed)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  message(STATUS "${ARGV}\n${output}")
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "exit code ${status}: ${ARGV}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

must_succeed(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})
must_succeed(${CMAKE_COMMAND} -S ${CONSUMER} -B ${SCRATCH}/build -DCMAKE_PREFIX_PATH=${prefix}
  -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_BUILD_TYPE=Release -DWANTED_VERSION=${VERSION})
must_succeed(${CMAKE_COMMAND} --build ${SCRATCH}/build)
must_succeed(${SCRATCH}/build/bin/consumer)

# A program installed beside the data finds that data, not the source tree's.
file(COPY ${SCRATCH}/build/bin/consumer DESTINATION ${prefix}/bin)
must_succeed(${CMAKE_COMMAND} -E env --unset=SCINTRAY_DATA ${prefix}/bin/consumer)
file(REAL_PATH ${prefix} prefix)
string(FIND "${output}" "data: ${prefix}/share/scintray" place)
if(place EQUAL -1)
  message(FATAL_ERROR "the installed program does not find ${prefix}/share/scintray")
endif()

must_succeed(${prefix}/bin/scintray --version)
string(FIND "${output}" "scintray ${VERSION}" place)
if(place EQUAL -1)
  message(FATAL_ERROR "the installed program does not say version ${VERSION}")
endif()
