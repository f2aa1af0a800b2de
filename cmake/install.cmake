# The program, and the shared library for find_package(fovea) and pkg-config.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

install(TARGETS fovea_app RUNTIME)
if(SKBUILD)
  install(TARGETS fovea_app RUNTIME DESTINATION ${SKBUILD_SCRIPTS_DIR} COMPONENT wheel)
endif()
if(NOT TARGET fovea_shared)
  return()
endif()
install(TARGETS fovea_shared EXPORT fovea_targets)
install(FILES ${api_headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/fovea)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/fovea)
install(EXPORT fovea_targets NAMESPACE fovea:: DESTINATION ${package})
configure_package_config_file(cmake/fovea-config.cmake.in ${PROJECT_BINARY_DIR}/fovea-config.cmake
                              INSTALL_DESTINATION ${package})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/fovea-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/fovea-config.cmake ${PROJECT_BINARY_DIR}/fovea-config-version.cmake
        DESTINATION ${package})
# The prefix from the file itself: `cmake --install --prefix` may choose another one.
file(RELATIVE_PATH FOVEA_PKGCONFIG_PREFIX /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
list(TRANSFORM FOVEA_EIGEN_ALIGNMENT PREPEND -D OUTPUT_VARIABLE alignment)
list(JOIN alignment " " FOVEA_PKGCONFIG_FLAGS)
configure_file(cmake/fovea.pc.in ${PROJECT_BINARY_DIR}/fovea.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/fovea.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
