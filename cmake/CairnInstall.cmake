# Installs what was built: libraries, headers, programs, the CMake package and the pkg-config files.
#
# Export sets, one for each component of the package: a user of Core needs no Bullet, and Bullet in
# one precision may be missing.
include(CMakePackageConfigHelpers)
set(cairn_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/cairn)

function(cairn_install_library target component)
  install(TARGETS ${target} EXPORT cairn${component}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(EXPORT cairn${component} NAMESPACE cairn:: DESTINATION ${cairn_package_dir}
    FILE cairn${component}Targets.cmake)
endfunction()

function(cairn_install_pkg_config name)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/${name}.pc.in ${PROJECT_BINARY_DIR}/${name}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endfunction()

# The way from the pkg-config files to the prefix: an installed tree may be moved.
file(RELATIVE_PATH CAIRN_PC_PREFIX
     ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
string(REGEX REPLACE "/$" "" CAIRN_PC_PREFIX ${CAIRN_PC_PREFIX})

# A static libcairn leaves Highway and oneTBB to be linked by its user.
set(CAIRN_STATIC ON)
set(CAIRN_PC_STATIC_LIBS "")
if(NOT CAIRN_HIGHWAY_FETCHED)
  string(APPEND CAIRN_PC_STATIC_LIBS " -lhwy")
endif()
if(CAIRN_TBB)
  string(APPEND CAIRN_PC_STATIC_LIBS " -ltbb")
else()
  string(APPEND CAIRN_PC_STATIC_LIBS " -pthread")
endif()
if(BUILD_SHARED_LIBS)
  set(CAIRN_STATIC OFF)
  set(CAIRN_PC_STATIC_LIBS "")
endif()

cairn_install_library(cairn Core)
cairn_install_pkg_config(cairn)
cairn_install_library(cairn_lcp Lcp)
cairn_install_pkg_config(cairn-lcp)
cairn_install_library(cairn_c C)
cairn_install_pkg_config(cairn-c)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/core/include/ ${PROJECT_SOURCE_DIR}/core/c/include/
                  ${PROJECT_SOURCE_DIR}/core/lcp/include/
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
if(TARGET cairn_bullet)
  cairn_install_library(cairn_bullet Bullet)
  cairn_install_pkg_config(cairn-bullet)
endif()
if(TARGET cairn_bullet_float64)
  cairn_install_library(cairn_bullet_float64 BulletFloat64)
  cairn_install_pkg_config(cairn-bullet-float64)
endif()
if(CAIRN_BULLET_PRECISIONS)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/bullet_adapter/include/
    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endif()

get_property(cairn_programs GLOBAL PROPERTY CAIRN_PROGRAMS)
if(cairn_programs)
  install(TARGETS ${cairn_programs} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/cairnConfig.cmake.in
  ${PROJECT_BINARY_DIR}/cairnConfig.cmake INSTALL_DESTINATION ${cairn_package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/cairnConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/cairnConfig.cmake ${PROJECT_BINARY_DIR}/cairnConfigVersion.cmake
              ${PROJECT_SOURCE_DIR}/cmake/FindCairnBullet.cmake
  DESTINATION ${cairn_package_dir})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/THIRD_PARTY.md
  DESTINATION ${CMAKE_INSTALL_DOCDIR})

# Archives: cpack -G TGZ, ZIP for Windows, DEB for one package of all. Debian's own four: packaging/build-debs.sh.
if(PROJECT_IS_TOP_LEVEL)
  set(CPACK_PACKAGE_NAME cairn)
  set(CPACK_PACKAGE_CONTACT "The Cairn authors")
  set(CPACK_PACKAGE_VENDOR "The Cairn authors")
  set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
  set(CPACK_STRIP_FILES ON)
  set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_PACKAGE_DEPENDS "libhwy-dev, libtbb-dev")
  set(CPACK_DEBIAN_PACKAGE_RECOMMENDS libeigen3-dev)
  set(CPACK_GENERATOR TGZ)
  if(WIN32)
    set(CPACK_GENERATOR ZIP)
  endif()
  include(CPack)
endif()
