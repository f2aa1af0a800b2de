# Tests of the thread sanitizer, and of a whole drive under it.

# The sanitizer must find races in parallel loops and around queues, and no others.
add_executable(planted_race ${CMAKE_CURRENT_LIST_DIR}/planted_race.cpp)
target_link_libraries(planted_race PRIVATE fovea_core fovea_compile_options)
add_dependencies(thread_tests planted_race)
foreach(race none loop queue)
  add_test(NAME planted_race_${race} COMMAND planted_race ${race})
  set_tests_properties(planted_race_${race} PROPERTIES TIMEOUT 60 LABELS threads)
endforeach()
set_tests_properties(planted_race_loop planted_race_queue PROPERTIES
                     PASS_REGULAR_EXPRESSION "WARNING: ThreadSanitizer: data race")

if(TARGET fovea_app AND FOVEA_WITH_SIMULATION)
  add_test(NAME threads COMMAND ${CMAKE_CURRENT_LIST_DIR}/threads.sh $<TARGET_FILE:fovea_app>
                                ${PROJECT_BINARY_DIR}/threads)
  set_tests_properties(threads PROPERTIES TIMEOUT 900 LABELS threads COST 100)
  add_dependencies(thread_tests fovea_app)
endif()
