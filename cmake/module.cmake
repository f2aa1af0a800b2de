# The precompiled header that every target shares; macros of single libraries stay out of it.
add_library(fovea_precompiled STATIC ${PROJECT_SOURCE_DIR}/cmake/precompiled.cpp)
target_link_libraries(fovea_precompiled PRIVATE Eigen3::Eigen fovea_compile_options)
target_compile_definitions(fovea_precompiled PRIVATE ${FOVEA_EIGEN_ALIGNMENT})
target_precompile_headers(fovea_precompiled PRIVATE ${PROJECT_SOURCE_DIR}/cmake/precompiled.h)

# Their tests run under the thread sanitizer.
set(FOVEA_MODULES_WITH_THREADS core drive map pipeline server)
add_custom_target(thread_tests)

# Most of a test's or a command's compilation is the same headers' templates over again. Files of most
# modules stay apart: their arithmetic shall not depend on what else is inlined.
function(fovea_compile_together target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${FOVEA_UNITY_BUILD} UNITY_BUILD_BATCH_SIZE 8)
  if(FOVEA_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    # Where much is inlined, it sees copies of std::string that cannot be (GCC bugs 105329, 105651).
    target_compile_options(${target} PRIVATE -Wno-restrict -Wno-array-bounds -Wno-stringop-overflow)
  endif()
endfunction()

# Each test is one of ctest's, so that one says by name what failed and they share the processors. A
# suite that prepares something for all of its tests (SetUpTestSuite) is one as a whole: it would
# prepare it anew for each. COST: long ones begin first, or the last would run alone. PROPERTIES: what
# each test has.
function(fovea_discover_tests target)
  cmake_parse_arguments(ARG "" "" "SOURCES;PROPERTIES" ${ARGN})
  set(suites)
  foreach(source IN LISTS ARG_SOURCES)
    file(STRINGS ${source} prepares REGEX "static void SetUpTestSuite")
    if(prepares)
      set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${source})
      file(STRINGS ${source} tests REGEX "^TEST_F\\(")
      list(TRANSFORM tests REPLACE "^TEST_F\\(([A-Za-z0-9_]+),.*" "\\1")
      list(APPEND suites ${tests})
    endif()
  endforeach()
  list(REMOVE_DUPLICATES suites)
  foreach(suite IN LISTS suites)
    add_test(NAME ${suite} COMMAND ${target} --gtest_filter=${suite}.*)
    set_tests_properties(${suite} PROPERTIES ${ARG_PROPERTIES} COST 100)
  endforeach()
  list(TRANSFORM suites APPEND .*)
  list(JOIN suites : filter)
  gtest_discover_tests(${target} DISCOVERY_TIMEOUT 60 TEST_FILTER "-${filter}" PROPERTIES ${ARG_PROPERTIES})
endfunction()

# Whether this build has all of the given modules: those outside FOVEA_PARTS are always there.
function(fovea_has_parts result)
  set(${result} TRUE PARENT_SCOPE)
  foreach(part IN LISTS ARGN)
    string(TOUPPER ${part} option)
    if(part IN_LIST FOVEA_PARTS AND NOT FOVEA_WITH_${option})
      set(${result} FALSE PARENT_SCOPE)
    endif()
  endforeach()
endfunction()

# fovea_part(NAME ...): fovea_module() of a part that a build may leave out (FOVEA_WITH_NAME).
function(fovea_part name)
  string(TOUPPER ${name} option)
  if(NOT FOVEA_WITH_${option})
    return()
  endif()
  cmake_parse_arguments(ARG "TOGETHER" "FOLDER" "DEPENDS;PRIVATE;TEST_DEPENDS" ${ARGN})
  foreach(part IN LISTS ARG_DEPENDS)
    fovea_has_parts(has_part ${part})
    if(NOT has_part)
      string(TOUPPER ${part} needed)
      message(FATAL_ERROR "FOVEA_WITH_${option} needs FOVEA_WITH_${needed}: set both to ON, or both to OFF")
    endif()
  endforeach()
  fovea_module(${name} ${ARGN})
endfunction()

# fovea_module(NAME [FOLDER folder] [WITHOUT folders...] [TOGETHER] [FUZZED] [DEPENDS modules...] [PUBLIC libs...]
#              [PRIVATE libs...] [TEST_DEPENDS modules...])
#
# Makes the static library fovea_NAME (alias fovea::NAME) from src/fovea/NAME, and the test program
# NAME_tests from the *_test.cpp files next to the sources.
#   FOLDER        folder in src/fovea/, if it is not NAME
#   WITHOUT       folders inside it that are modules of their own
#   TOGETHER      compiles several files together: the module computes neither maps nor figures
#   TEST_DEPENDS  modules that only the tests include, such as the reader of the module's files
#   FUZZED        fuzzers (fuzz/) read with it: their builds note which of its branches an input took
function(fovea_module name)
  cmake_parse_arguments(ARG "TOGETHER;FUZZED" "FOLDER" "WITHOUT;DEPENDS;PUBLIC;PRIVATE;TEST_DEPENDS" ${ARGN})
  if(NOT ARG_FOLDER)
    set(ARG_FOLDER ${name})
  endif()
  set(root ${PROJECT_SOURCE_DIR}/src/fovea/${ARG_FOLDER})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${root}/*.cpp)
  file(GLOB_RECURSE tests CONFIGURE_DEPENDS ${root}/*_test.cpp)
  foreach(folder IN LISTS ARG_WITHOUT)
    list(FILTER sources EXCLUDE REGEX "^${root}/${folder}/")
    list(FILTER tests EXCLUDE REGEX "^${root}/${folder}/")
  endforeach()
  list(REMOVE_ITEM sources ${tests})

  add_library(fovea_${name} STATIC ${sources})
  target_include_directories(fovea_${name} PUBLIC ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src)
  list(TRANSFORM ARG_DEPENDS PREPEND fovea_ OUTPUT_VARIABLE modules)
  target_link_libraries(fovea_${name} PUBLIC ${modules} ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE} fovea_compile_options)
  target_compile_definitions(fovea_${name} PUBLIC ${FOVEA_EIGEN_ALIGNMENT})
  target_compile_features(fovea_${name} PUBLIC cxx_std_20)
  if(ARG_TOGETHER)
    fovea_compile_together(fovea_${name})
  endif()
  if(ARG_FUZZED AND FOVEA_BUILD_FUZZERS)
    target_compile_options(fovea_${name} PRIVATE
                           -fsanitize-coverage=inline-8bit-counters,indirect-calls,trace-cmp,pc-table)
  endif()
  target_precompile_headers(fovea_${name} REUSE_FROM fovea_precompiled)
  set_property(GLOBAL APPEND PROPERTY FOVEA_MODULES fovea_${name})

  fovea_has_parts(can_test ${ARG_TEST_DEPENDS})
  if(FOVEA_BUILD_TESTS AND tests AND NOT can_test)
    message(STATUS "${name}_tests is left out: it needs all of ${ARG_TEST_DEPENDS}")
  elseif(FOVEA_BUILD_TESTS AND tests)
    add_executable(${name}_tests ${tests})
    list(TRANSFORM ARG_TEST_DEPENDS PREPEND fovea_)
    target_link_libraries(${name}_tests PRIVATE fovea_${name} ${ARG_TEST_DEPENDS} ${ARG_PRIVATE}
                          fovea_compile_options GTest::gtest_main GTest::gmock)
    fovea_compile_together(${name}_tests)
    target_precompile_headers(${name}_tests REUSE_FROM fovea_precompiled)
    target_compile_definitions(${name}_tests PRIVATE
                               FOVEA_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
    set(label ${name})
    if(name IN_LIST FOVEA_MODULES_WITH_THREADS)
      set(label ${name},threads)
      add_dependencies(thread_tests ${name}_tests)
    endif()
    fovea_discover_tests(${name}_tests SOURCES ${tests} PROPERTIES TIMEOUT 600 LABELS ${label})
  endif()
endfunction()
