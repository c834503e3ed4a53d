cmake_minimum_required(VERSION 3.25)
# Writes a ctest file with one test per doctest case of a program; run after the program is linked:
#   cmake -D PROGRAM=... -D PREFIX=... -D OUT=... -P discover.cmake
# Cases are selected by number (--first, --last), so a name may hold any character; in ctest's list those that CMake
# gives a meaning of its own are replaced.
execute_process(COMMAND ${PROGRAM} --list-test-cases --no-colors OUTPUT_VARIABLE output RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  file(REMOVE ${PROGRAM})
  message(FATAL_ERROR "${PROGRAM} --list-test-cases failed: ${result}\n${output}")
endif()
string(REPLACE ";" "," output "${output}")
string(REPLACE "[" "(" output "${output}")
string(REPLACE "]" ")" output "${output}")
string(REPLACE "\\" "/" output "${output}")
string(REPLACE "\n" ";" lines "${output}")
set(script "")
set(names "")
set(number 0)
foreach(line IN LISTS lines)
  if(line STREQUAL "" OR line MATCHES "^=+$" OR line MATCHES "^\\(doctest\\) ")
    continue()
  endif()
  math(EXPR number "${number} + 1")
  set(name "${PREFIX}: ${line}")
  if(name IN_LIST names)
    string(APPEND name " (${number})")
  endif()
  list(APPEND names "${name}")
  # a case that checks nothing would pass in silence
  string(APPEND script "add_test([==[${name}]==] [==[${PROGRAM}]==] --first=${number} --last=${number} --no-colors)\n"
    "set_tests_properties([==[${name}]==] PROPERTIES TIMEOUT 300 FAIL_REGULAR_EXPRESSION [==[assertions: +0 ]==])\n")
endforeach()
file(WRITE ${OUT} "${script}")
