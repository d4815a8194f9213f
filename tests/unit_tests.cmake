# SPDX-License-Identifier: Apache-2.0
include(GoogleTest)
file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/wholes)

# add_unit_tests(PROGRAM SHARDS [PREFIX PREFIX] [LEAVE_OUT FILTER] [ENVIRONMENT VARIABLE=VALUE...]): the tests of a GoogleTest program twice.
# Each by itself, with the label unit, for `ctest -R NAME`; and all of them in SHARDS processes, with the label whole, for script/test,
# as a process for each test takes longer. A whole run lists its tests in build/PRESET/wholes/PROGRAM.SHARD.xml.
function(add_unit_tests program shards)
  cmake_parse_arguments(PARSE_ARGV 2 arg "" "PREFIX;LEAVE_OUT" "ENVIRONMENT")
  if(arg_LEAVE_OUT)
    set(filter -${arg_LEAVE_OUT})
  else()
    set(filter *)
  endif()
  set(prefix)
  if(arg_PREFIX)
    set(prefix TEST_PREFIX ${arg_PREFIX})
  endif()
  gtest_discover_tests(${program} ${prefix} TEST_FILTER ${filter} NO_PRETTY_VALUES DISCOVERY_TIMEOUT 60
    PROPERTIES LABELS unit TIMEOUT 300)
  math(EXPR last "${shards} - 1")
  foreach(shard RANGE ${last})
    set(name whole.${program}.${shard})
    add_test(NAME ${name} COMMAND ${program} --gtest_brief=1 --gtest_filter=${filter} --gtest_output=xml:${CMAKE_BINARY_DIR}/wholes/${program}.${shard}.xml)
    list(TRANSFORM arg_ENVIRONMENT REPLACE SHARD ${shard} OUTPUT_VARIABLE environment)
    set_tests_properties(${name} PROPERTIES LABELS whole TIMEOUT 1800 COST 100
      ENVIRONMENT "GTEST_TOTAL_SHARDS=${shards};GTEST_SHARD_INDEX=${shard};${environment}")
  endforeach()
endfunction()
