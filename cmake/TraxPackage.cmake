# `cpack --config build/CPackConfig.cmake -B DIR`: trax_VERSION_amd64.deb, which is what TraxInstall installs but for the names `clang` and
# `clang++`: Debian's own clang has them. tests/package tries it.

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME trax)
set(CPACK_PACKAGE_CONTACT "The authors of trax <trax@trax.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "compiler, simulator and ray tracer for a mobile ray-tracing chip")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION "A cycle-exact simulator of the accelerator of the paper
A Mobile Accelerator Architecture for Ray Tracing, with a C and C++
compiler, an assembler, a linker and a C library for its processors,
a ray tracer for it, and the paper's evaluation.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION devel)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# What no library says: clang's own headers, those of C++, trax-eval's interpreter.
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libclang-common-${LLVM_VERSION_MAJOR}-dev, libc++-${LLVM_VERSION_MAJOR}-dev, python3")
# For programs that link the emulator, and for its package of Python.
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "parallel, draco, npm, python3-cffi, python3-numpy, python3-pandas, pkgconf, libelf-dev, libdw-dev, libconfig-dev, libjansson-dev, libxxhash-dev, zlib1g-dev")
set(CPACK_PROJECT_CONFIG_FILE ${CMAKE_CURRENT_LIST_DIR}/debian/tools.cmake)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/debian/files.cmake)
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${CMAKE_CURRENT_LIST_DIR}/debian/prerm)
set(CPACK_TRAX_SOURCE ${PROJECT_SOURCE_DIR})
include(CPack)
