# A command's man page and its completion in bash, which the command itself prints from its table of options
# (emulator/base/option_pages.c).
function(trax_pages command)
  set(man ${CMAKE_BINARY_DIR}/share/man/man1/${command}.1)
  set(completion ${CMAKE_BINARY_DIR}/share/bash-completion/completions/${command})
  file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/share/man/man1 ${CMAKE_BINARY_DIR}/share/bash-completion/completions)
  add_custom_command(TARGET ${command} POST_BUILD
    COMMAND ${command} --help-man > ${man}
    COMMAND ${command} --help-completion > ${completion}
    BYPRODUCTS ${man} ${completion} VERBATIM)
  install(FILES ${man} DESTINATION share/man/man1)
  install(FILES ${completion} DESTINATION share/bash-completion/completions)
endfunction()
