# Does what somebody with a method of their own does: installs Driftless, compiles the method against
# it, lists it, runs a study of it, has it judged, and holds it to the suites. Then the same once more, compiled for
# the processor at hand, and so perhaps for other instructions than the library.
#
# cmake -DBUILD=... -DSCRATCH=... -DCOMPILER=... -DGENERATOR=... -P check.cmake
set(example ${CMAKE_CURRENT_LIST_DIR})
set(prefix ${SCRATCH}/installed)
set(program ${prefix}/bin/driftless)
set(warnings "-Wall -Wextra -Wpedantic -Wshadow -Werror")
file(REMOVE_RECURSE ${SCRATCH})

# call(COMMAND...): stops the test if it fails; what it printed is left in `output`.
function(call)
  list(JOIN ARGV " " words)
  message(STATUS "${words}")
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE result OUTPUT_VARIABLE output
    ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "it ended with ${result}:\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

function(expect text pattern)
  if(NOT text MATCHES "${pattern}")
    message(FATAL_ERROR "'${pattern}' is not in:\n${text}")
  endif()
endfunction()

# compile(FOLDER FLAGS): leaves the compiled example in `module`.
function(compile folder flags)
  call(${CMAKE_COMMAND} -G ${GENERATOR} -S ${example} -B ${folder} -DCMAKE_PREFIX_PATH=${prefix}
    -DCMAKE_CXX_COMPILER=${COMPILER} "-DCMAKE_CXX_FLAGS=${warnings} ${flags}")
  call(${CMAKE_COMMAND} --build ${folder})
  set(module ${folder}/my_euler.so PARENT_SCOPE)
endfunction()

# check_suites(MODULE SUITE...): holds the method to what these hold every method to.
function(check_suites module)
  foreach(suite ${ARGN})
    call(${CMAKE_COMMAND} -E env DRIFTLESS_METHODS=${module} ${BUILD}/tests/${suite}_test
      --gtest_filter=*/example_euler*)
    expect("${output}" "PASSED  . [1-9]")
  endforeach()
endfunction()

call(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})
compile(${SCRATCH}/build "")

call(${program} --methods ${module} methods)
expect("${output}" "\nexample-euler\n")

call(${program} --methods ${module} run ${example}/study.json -q -o ${SCRATCH}/result)
file(READ ${SCRATCH}/result/result.json result)
string(JSON method GET "${result}" cells 0 method)
string(JSON status GET "${result}" cells 0 status)
string(JSON command GET "${result}" provenance command)
string(JSON instructions GET "${result}" provenance instructions)
expect("${method} ${status}" "^example-euler ok$")
expect("${command}" "--methods ${module}")
expect("${instructions}" "^[A-Z]")

call(${program} --methods ${module} judge example-euler -q -o ${SCRATCH}/judgement)
# Every examination, in the order of reports. What cannot be resolved so quickly may well be elsewhere.
set(seen "(holds|not resolved)")
expect("${output}" "\n. example-euler . holds . holds . ${seen} . ${seen} . reported . holds . ${seen} . fails . ${seen} .\n")

check_suites(${module} invariants long_run noise_free species storage two_body walls)
compile(${SCRATCH}/build-native -march=native)
check_suites(${module} invariants)
