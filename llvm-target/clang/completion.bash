# Completes the options of trax-clang and trax-clang++ in bash, as clang lists them itself (--autocomplete).
_trax_clang() {
  local word=${COMP_WORDS[COMP_CWORD]} given= flags i
  for ((i = 1; i <= COMP_CWORD; i++)); do # with commas between, and one behind each "="
    given+=${COMP_WORDS[i]}
    ((i == COMP_CWORD)) || [[ ${COMP_WORDS[i + 1]} == = ]] || given+=,
  done
  [[ $word != = ]] || word=
  flags=$("${COMP_WORDS[0]}" --autocomplete="$given" 2>/dev/null | cut -f1)
  if [[ $flags && $given ]]; then
    COMPREPLY=($(compgen -W "$flags" -- "$word"))
    [[ ${#COMPREPLY[@]} != 1 || ${COMPREPLY[0]} != *= ]] || compopt -o nospace 2>/dev/null
  else
    COMPREPLY=($(compgen -f -- "$word"))
  fi
}
complete -o filenames -F _trax_clang trax-clang trax-clang++
