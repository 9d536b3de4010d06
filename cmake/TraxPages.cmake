# A command's man page, made of what it says with --help, and its completion in bash.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
# The interpreter itself: a script in its place, such as pyenv's, takes longer than most that it starts.
execute_process(COMMAND ${Python3_EXECUTABLE} -c "import sys; print(sys.executable)" OUTPUT_VARIABLE Python3_EXECUTABLE
                OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
set(TRAX_HELP_TO_MAN ${CMAKE_CURRENT_LIST_DIR}/help_to_man.py)
set(TRAX_HELP_TO_COMPLETION ${CMAKE_CURRENT_LIST_DIR}/help_to_completion.py)

# completion: MADE of --help, or PRINTED by the command itself from its table of options (emulator/base/completion.c). A further
# argument: other pages to see.
function(trax_pages command completion summary)
  set(man ${CMAKE_BINARY_DIR}/share/man/man1/${command}.1)
  set(script ${CMAKE_BINARY_DIR}/share/bash-completion/completions/${command})
  set(completer ${command} --help-completion)
  if(completion STREQUAL MADE)
    set(completer ${Python3_EXECUTABLE} -B ${TRAX_HELP_TO_COMPLETION} $<TARGET_FILE:${command}> ${command})
  endif()
  file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/share/man/man1 ${CMAKE_BINARY_DIR}/share/bash-completion/completions)
  add_custom_command(TARGET ${command} POST_BUILD
    COMMAND ${Python3_EXECUTABLE} -B ${TRAX_HELP_TO_MAN} $<TARGET_FILE:${command}> ${command} ${summary} ${PROJECT_VERSION} ${ARGN} > ${man}
    COMMAND ${completer} > ${script}
    BYPRODUCTS ${man} ${script} VERBATIM)
  install(FILES ${man} DESTINATION share/man/man1)
  install(FILES ${script} DESTINATION share/bash-completion/completions)
endfunction()
