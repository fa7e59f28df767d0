# SPDX-License-Identifier: MIT
vcpkg_download_distfile(archive
    URLS "https://example.org/rlvc/rlvc-source-${VERSION}.tar.gz"
    FILENAME "rlvc-source-${VERSION}.tar.gz"
    SHA512 @SHA512@)
vcpkg_extract_source_archive(source ARCHIVE "${archive}")
vcpkg_cmake_configure(
    SOURCE_PATH "${source}"
    OPTIONS -DRLVC_VISION=OFF -DRLVC_TOOLS=OFF -DRLVC_EXAMPLES=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/rlvc)
vcpkg_fixup_pkgconfig()
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include" "${CURRENT_PACKAGES_DIR}/debug/share")
vcpkg_install_copyright(FILE_LIST "${source}/LICENSE")
file(INSTALL "${CMAKE_CURRENT_LIST_DIR}/usage" DESTINATION "${CURRENT_PACKAGES_DIR}/share/${PORT}")
