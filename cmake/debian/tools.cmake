# CPack reads this before it begins. A package whose dependencies nobody found would install programs that do not start.

if(CPACK_GENERATOR STREQUAL DEB)
  foreach(needed "dpkg-shlibdeps dpkg-dev" "file file")
    separate_arguments(needed)
    list(GET needed 0 program)
    list(GET needed 1 package)
    find_program(TRAX_${program} ${program})
    if(NOT TRAX_${program})
      message(FATAL_ERROR "cpack needs ${program} to find what the package depends on: apt-get install ${package}")
    endif()
  endforeach()
endif()
