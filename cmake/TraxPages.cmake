# A command's man page and its completion in bash, which the command itself prints from its table of options
# (emulator/base/option_pages.c).
find_package(Python3 REQUIRED COMPONENTS Interpreter)
# The interpreter itself: a script in its place, such as pyenv's, takes longer than most that it starts.
execute_process(COMMAND ${Python3_EXECUTABLE} -c "import sys; print(sys.executable)" OUTPUT_VARIABLE Python3_EXECUTABLE
                OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
set(TRAX_HELP_TO_MAN ${CMAKE_CURRENT_LIST_DIR}/help_to_man.py)
set(TRAX_HELP_TO_COMPLETION ${CMAKE_CURRENT_LIST_DIR}/help_to_completion.py)

# Both for a program that has no such table, made of what it says with --help.
function(trax_help_pages command summary)
  set(man ${CMAKE_BINARY_DIR}/share/man/man1/${command}.1)
  set(completion ${CMAKE_BINARY_DIR}/share/bash-completion/completions/${command})
  file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/share/man/man1 ${CMAKE_BINARY_DIR}/share/bash-completion/completions)
  add_custom_command(TARGET ${command} POST_BUILD
    COMMAND ${Python3_EXECUTABLE} -B ${TRAX_HELP_TO_MAN} $<TARGET_FILE:${command}> ${command} ${summary} ${PROJECT_VERSION} > ${man}
    COMMAND ${Python3_EXECUTABLE} -B ${TRAX_HELP_TO_COMPLETION} $<TARGET_FILE:${command}> ${command} > ${completion}
    BYPRODUCTS ${man} ${completion} VERBATIM)
  install(FILES ${man} DESTINATION share/man/man1)
  install(FILES ${completion} DESTINATION share/bash-completion/completions)
endfunction()

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
