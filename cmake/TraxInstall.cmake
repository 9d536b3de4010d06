# `cmake --install BUILD --prefix PREFIX`: a tree that works wherever it is moved to, since every program finds its parts from
# its own place.

include(CMakePackageConfigHelpers)

install(TARGETS clang trax-mc trax-objdump trax-sim)
foreach(link clang++ trax-clang trax-clang++)
  install(FILES ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}/${link} DESTINATION bin) # symbolic links stay what they are
endforeach()

set(runtime ${CMAKE_LIBRARY_OUTPUT_DIRECTORY}/trax)
install(DIRECTORY ${runtime}/include DESTINATION lib/trax)
install(FILES ${runtime}/crt0.o ${runtime}/crt0-global-stack.o ${runtime}/libc.a ${runtime}/libm.a ${runtime}/libgcc.a
              ${runtime}/libpthread.a ${runtime}/libdl.a ${runtime}/librt.a
              ${runtime}/COPYING.NEWLIB ${runtime}/trax-toolchain.cmake ${runtime}/trax-meson.ini ${runtime}/stock-clang.cfg
        DESTINATION lib/trax)

# The emulator as a library, for CMake and for pkg-config.
install(TARGETS traxemu traxisa traxbase ARCHIVE DESTINATION lib)
set(headers ${PROJECT_SOURCE_DIR}/emulator/include/trax)
set(base ${PROJECT_SOURCE_DIR}/emulator/base/include/trax)
install(FILES ${headers}/emulator.h ${headers}/explain.h ${headers}/manifest.h ${base}/files.h ${base}/processors.h ${base}/status.h
        DESTINATION include/trax)
install(FILES ${PROJECT_SOURCE_DIR}/cmake/traxConfig.cmake DESTINATION lib/cmake/trax)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/traxConfigVersion.cmake COMPATIBILITY SameMinorVersion ARCH_INDEPENDENT)
install(FILES ${PROJECT_BINARY_DIR}/traxConfigVersion.cmake DESTINATION lib/cmake/trax)
configure_file(${PROJECT_SOURCE_DIR}/cmake/trax-emulator.pc.in ${PROJECT_BINARY_DIR}/trax-emulator.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/trax-emulator.pc DESTINATION lib/pkgconfig)
