# The installed package: find_package(Polder [COMPONENTS core mpm fdm io coupling]) gives targets Polder::NAME.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Polder)
get_property(POLDER_MODULES GLOBAL PROPERTY POLDER_MODULES)
get_property(POLDER_DEPENDENCIES GLOBAL PROPERTY POLDER_DEPENDENCIES)

install(EXPORT PolderTargets NAMESPACE Polder:: DESTINATION ${package_dir})
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/PolderConfig.cmake.in ${PROJECT_BINARY_DIR}/PolderConfig.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/PolderConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/PolderConfig.cmake ${PROJECT_BINARY_DIR}/PolderConfigVersion.cmake
        DESTINATION ${package_dir})

# Find modules for libraries without a CMake package of their own travel along.
file(GLOB find_modules ${PROJECT_SOURCE_DIR}/cmake/Find*.cmake)
install(FILES ${find_modules} DESTINATION ${package_dir})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
