# Installs the build into a folder beside it, then configures, builds and runs a program of a
# stranger that knows gnomon only by find_package.
function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    list(JOIN ARGV " " command)
    message(FATAL_ERROR "${command}\nended with ${status}:\n${output}")
  endif()
endfunction()

set(work ${BUILD_DIR}/install_test)
file(REMOVE_RECURSE ${work})
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${work}/prefix)
run(${CMAKE_COMMAND} -S ${SOURCE_DIR} -B ${work}/build -G Ninja -D CMAKE_PREFIX_PATH=${work}/prefix
  -D WITH_AR=${WITH_AR} -D CMAKE_CXX_COMPILER=${COMPILER} -D CMAKE_CXX_FLAGS=${FLAGS}
  -D CMAKE_BUILD_TYPE=${BUILD_TYPE} -D EXAMPLE_TEST=${SOURCE_DIR}/../testing/example_test.cpp)
run(${CMAKE_COMMAND} --build ${work}/build)
run(${work}/build/use_raster)
run(${work}/build/use_testing)
if(WITH_AR)
  run(${work}/build/use_ar)
endif()
file(REMOVE_RECURSE ${work})
