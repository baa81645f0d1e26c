# What `cmake --install` puts where, and the files that make `find_package(skyhalo)` work.
include(CMakePackageConfigHelpers)

install(
  TARGETS skyhalo
  EXPORT skyhalo-targets
  FILE_SET HEADERS)
if(SKYHALO_BUILD_APPS)
  install(TARGETS skyhalo_program)
endif()

set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/skyhalo")
install(EXPORT skyhalo-targets NAMESPACE skyhalo:: DESTINATION "${package_dir}")
configure_package_config_file(cmake/skyhaloConfig.cmake.in "${PROJECT_BINARY_DIR}/skyhaloConfig.cmake"
                              INSTALL_DESTINATION "${package_dir}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/skyhaloConfigVersion.cmake"
                                 COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/skyhaloConfig.cmake"
              "${PROJECT_BINARY_DIR}/skyhaloConfigVersion.cmake" DESTINATION "${package_dir}")
install(DIRECTORY config/ DESTINATION "${CMAKE_INSTALL_DATADIR}/skyhalo/config")
