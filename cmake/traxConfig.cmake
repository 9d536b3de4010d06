# find_package(trax CONFIG), in a project for the host or one for the TP:
#
#   trax::clang, trax::trax-ld, trax::trax-sim, trax::trax-mc, trax::trax-objdump   programs
#   trax::emulator                                                                  library, <trax/emulator.h>; for the host
#   trax_add_executable(NAME SOURCE... [OPTIONS FLAG...])                           a program for the TP
#   TRAX_TOOLCHAIN_FILE                                                             for projects that are all for the TP
#
# trax_add_executable compiles and links with trax::clang, whatever the project's own compiler is. The target's property
# TRAX_PROGRAM is the program's path. FLAGs go to both compiling and linking.

get_filename_component(TRAX_PREFIX "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
set(TRAX_TOOLCHAIN_FILE "${TRAX_PREFIX}/lib/trax/trax-toolchain.cmake")

foreach(program clang trax-ld trax-sim trax-mc trax-objdump)
  set(TRAX_FILE "${TRAX_PREFIX}/bin/${program}")
  if(program STREQUAL "clang") # a Debian package has no other name for it
    set(TRAX_FILE "${TRAX_PREFIX}/bin/trax-clang")
  endif()
  if(NOT EXISTS "${TRAX_FILE}")
    set(trax_FOUND FALSE)
    set(trax_NOT_FOUND_MESSAGE "${TRAX_FILE} is missing: the installation is incomplete")
    return()
  endif()
  if(NOT TARGET trax::${program})
    add_executable(trax::${program} IMPORTED)
    set_target_properties(trax::${program} PROPERTIES IMPORTED_LOCATION "${TRAX_FILE}")
  endif()
endforeach()

if(NOT CMAKE_SYSTEM_PROCESSOR STREQUAL "trax" AND NOT TARGET trax::emulator)
  include(CMakeFindDependencyMacro)
  find_dependency(PkgConfig)
  pkg_check_modules(TRAX_EMULATOR_NEEDS QUIET IMPORTED_TARGET libelf libdw libconfig jansson libxxhash zlib)
  if(TRAX_EMULATOR_NEEDS_FOUND)
    add_library(trax::emulator STATIC IMPORTED)
    set_target_properties(trax::emulator PROPERTIES
      IMPORTED_LOCATION "${TRAX_PREFIX}/lib/libtraxemu.a"
      INTERFACE_INCLUDE_DIRECTORIES "${TRAX_PREFIX}/include"
      INTERFACE_LINK_LIBRARIES "${TRAX_PREFIX}/lib/libtraxisa.a;${TRAX_PREFIX}/lib/libtraxbase.a;PkgConfig::TRAX_EMULATOR_NEEDS;m")
  elseif(NOT trax_FIND_QUIETLY)
    message(STATUS "trax: no trax::emulator, since pkg-config does not find libelf, libdw, libconfig, jansson, libxxhash and zlib")
  endif()
endif()

function(trax_add_executable name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" OPTIONS)
  set(sources ${arg_UNPARSED_ARGUMENTS})
  if(NOT sources)
    message(FATAL_ERROR "trax_add_executable(${name}): no sources")
  endif()
  if(CMAKE_SYSTEM_PROCESSOR STREQUAL "trax")
    add_executable(${name} ${sources})
    target_compile_options(${name} PRIVATE ${arg_OPTIONS})
    target_link_options(${name} PRIVATE ${arg_OPTIONS})
    set_target_properties(${name} PROPERTIES TRAX_PROGRAM "$<TARGET_FILE:${name}>")
    return()
  endif()

  set(compiler $<TARGET_FILE:trax::clang> --target=trax ${arg_OPTIONS})
  set(directory "${CMAKE_CURRENT_BINARY_DIR}/${name}.trax")
  file(MAKE_DIRECTORY "${directory}")
  set(objects)
  foreach(source ${sources})
    get_filename_component(path "${source}" ABSOLUTE)
    list(LENGTH objects number)
    get_filename_component(file "${source}" NAME)
    set(object "${directory}/${number}-${file}.o")
    add_custom_command(OUTPUT "${object}"
      COMMAND ${compiler} -MD -MF "${object}.d" -MT "${object}" -c "${path}" -o "${object}"
      DEPENDS "${path}" "${TRAX_PREFIX}/bin/trax-clang" DEPFILE "${object}.d" VERBATIM
      COMMENT "Compiling ${source} for the TP")
    list(APPEND objects "${object}")
  endforeach()
  set(program "${CMAKE_CURRENT_BINARY_DIR}/${name}.elf")
  add_custom_command(OUTPUT "${program}" COMMAND ${compiler} ${objects} -o "${program}"
    DEPENDS ${objects} "${TRAX_PREFIX}/bin/trax-ld" "${TRAX_PREFIX}/lib/trax/libc.a" VERBATIM
    COMMENT "Linking ${name}.elf for the TP")
  add_custom_target(${name} ALL DEPENDS "${program}")
  set_target_properties(${name} PROPERTIES TRAX_PROGRAM "${program}")
endfunction()
