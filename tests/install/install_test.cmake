# Installs the build into a folder of its own, bakes a light field with the installed command, builds the host and runs it.
function(step name)
    execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
    string(FIND "${output}" "validation: " message)
    if(NOT status EQUAL 0 OR NOT message EQUAL -1)
        message(FATAL_ERROR "${name} failed (${status}):\n${output}")
    endif()
    message(STATUS "${name}\n${output}")
endfunction()

file(REMOVE_RECURSE ${WORK})
set(ENV{SCONCE_VALIDATION} 1)
step("Installation" ${CMAKE_COMMAND} --install ${BUILD} --config ${CONFIG} --prefix ${WORK}/prefix)
# What is installed is what the list says, no more and no less: the opponents, the tests' hooks and every other header stay at home.
file(GLOB_RECURSE installed RELATIVE ${WORK}/prefix LIST_DIRECTORIES false ${WORK}/prefix/*)
list(SORT installed)
string(REPLACE ";" "\n" installed "${installed}\n")
string(REGEX REPLACE "lib/[a-z0-9_-]*linux[a-z0-9_-]*/" "lib/" installed "${installed}")
string(REGEX REPLACE "targets-[a-z]+\\.cmake" "targets-CONFIG.cmake" installed "${installed}")
file(READ ${HOST}/../installed_tree.txt listed)
if(NOT installed STREQUAL listed)
    message(FATAL_ERROR "The installed tree is not that of tests/install/installed_tree.txt, but:\n${installed}")
endif()
step("Bake" ${WORK}/prefix/bin/sconce bake cornell --probes ${HOST}/probes.json -o ${WORK}/cornell.sconce --resolution 128 --bounces 1)
step("Configuration of the host" ${CMAKE_COMMAND} -S ${HOST} -B ${WORK}/build -G ${GENERATOR} -DCMAKE_BUILD_TYPE=${CONFIG}
     -DCMAKE_PREFIX_PATH=${WORK}/prefix -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}
     -DCMAKE_CXX_FLAGS=${FLAGS} -DKEEP_MODULES=${KEEP_MODULES})
step("Build of the host" ${CMAKE_COMMAND} --build ${WORK}/build --config ${CONFIG})
step("Run of the host" ${WORK}/build/host ${WORK}/cornell.sconce)
