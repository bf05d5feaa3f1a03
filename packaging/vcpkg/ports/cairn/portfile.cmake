# Of this folder of sources: a port for the registry takes vcpkg_from_git() or its like here, with the hash of a release.
get_filename_component(SOURCE_PATH "${CMAKE_CURRENT_LIST_DIR}/../../../.." ABSOLUTE)

vcpkg_check_features(OUT_FEATURE_OPTIONS options FEATURES tbb CAIRN_TBB)
set(bullet off)
if("bullet" IN_LIST FEATURES)
  set(bullet float)
endif()

vcpkg_cmake_configure(SOURCE_PATH "${SOURCE_PATH}"
  OPTIONS ${options} -DCAIRN_BULLET=${bullet} -DCAIRN_TOOLS=OFF -DCAIRN_TESTS=OFF -DCAIRN_EXAMPLES=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(PACKAGE_NAME cairn CONFIG_PATH lib/cmake/cairn)
vcpkg_fixup_pkgconfig()
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include" "${CURRENT_PACKAGES_DIR}/debug/share")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE" "${SOURCE_PATH}/THIRD_PARTY.md")
