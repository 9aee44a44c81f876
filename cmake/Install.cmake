# cmake --install: the program, its scenes and manual page; the library, its headers and its CMake package.
include(CMakePackageConfigHelpers)

install(TARGETS isoparm_lib EXPORT isoparmTargets)
if(TARGET isoparm)
    install(TARGETS isoparm)
    install(TARGETS isoparm_image DESTINATION lib/isoparm)  # where the program looks: ../lib/isoparm, on every system
    if(TARGET isoparm_opencascade)
        install(TARGETS isoparm_opencascade DESTINATION lib/isoparm)
    endif()
endif()

install(DIRECTORY lib/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/isoparm FILES_MATCHING PATTERN "*.h"
    PATTERN "limit_refiner.h" EXCLUDE)  # OpenSubdiv's types stay inside
install(FILES "${PROJECT_BINARY_DIR}/isoparm_version.h" DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/isoparm)
install(CODE "set(ISOPARM_HEADERS \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_INCLUDEDIR}/isoparm\")")
install(SCRIPT cmake/installed_includes.cmake)

set(package ${CMAKE_INSTALL_LIBDIR}/cmake/isoparm)
configure_package_config_file(cmake/isoparmConfig.cmake.in isoparmConfig.cmake INSTALL_DESTINATION ${package})
write_basic_package_version_file(isoparmConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(EXPORT isoparmTargets NAMESPACE isoparm:: DESTINATION ${package})
install(FILES "${PROJECT_BINARY_DIR}/isoparmConfig.cmake" "${PROJECT_BINARY_DIR}/isoparmConfigVersion.cmake"
    cmake/FindOpenSubdiv.cmake DESTINATION ${package})

install(DIRECTORY scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/isoparm OPTIONAL)
install(FILES docs/isoparm.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 OPTIONAL)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
