# The program, the headers, the archives and find_package(fovea).
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

get_property(modules GLOBAL PROPERTY FOVEA_MODULES)
add_library(fovea_all INTERFACE)
set_target_properties(fovea_all PROPERTIES EXPORT_NAME fovea)
target_link_libraries(fovea_all INTERFACE ${modules})

install(TARGETS fovea_app RUNTIME)
install(TARGETS ${modules} fovea_all EXPORT fovea_targets)
install(DIRECTORY src/fovea DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        FILES_MATCHING PATTERN "*.h" PATTERN "*test_*" EXCLUDE)
install(EXPORT fovea_targets NAMESPACE fovea:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/fovea)
install(FILES cmake/dependencies.cmake DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/fovea)
set(FOVEA_PART_OPTIONS "")
foreach(part IN LISTS FOVEA_PARTS)
  string(TOUPPER ${part} option)
  string(APPEND FOVEA_PART_OPTIONS "set(FOVEA_WITH_${option} ${FOVEA_WITH_${option}})\n")
endforeach()
configure_package_config_file(cmake/fovea-config.cmake.in ${PROJECT_BINARY_DIR}/fovea-config.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/fovea)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/fovea-config-version.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/fovea-config.cmake
              ${PROJECT_BINARY_DIR}/fovea-config-version.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/fovea)
