"""The completion of trax-eval in bash, from its options, experiments, programs and scenes."""

from compare import main as comparison
from fetch import main as fetch
from report import docs, make

from .options import OPTIONS, job_parser

COMMANDS = {"report": make.new_parser, "docs": docs.new_parser, "fetch-scenes": fetch.new_parser,
            "compare": comparison.new_parser, "job": job_parser}

SCRIPT = """\
# Completes the options and experiments of trax-eval in bash.
_trax_eval() {
  local word=${COMP_WORDS[COMP_CWORD]} option=${COMP_WORDS[COMP_CWORD - 1]}
  if [[ $word == = ]]; then
    word=
  elif [[ $option == = ]]; then
    option=${COMP_WORDS[COMP_CWORD - 2]}
  fi
  COMPREPLY=()
  if ((COMP_CWORD > 1)); then
    case ${COMP_WORDS[1]} in
%s
    esac
  fi
  case $option in
%s
  esac
  if [[ $word == -* ]]; then
    mapfile -t COMPREPLY < <(%s)
  else
    mapfile -t COMPREPLY < <(%s)
  fi
}
complete -o filenames -F _trax_eval trax-eval"""


def words(values, mark=""):
    """A command of bash: those of the words that begin as the word does; of a list, its last value."""
    values = " ".join(values)
    if mark:
        return f"compgen -P \"${{word%\"${{word##*{mark}}}\"}}\" -W '{values}' -- \"${{word##*{mark}}}\""
    return f"compgen -W '{values}' -- \"$word\""


def files(kind):
    return f'compgen -{kind} -- "${{word//\\\\/}}"'  # a blank that was typed has a backslash


def value_of(option, data):
    """A row of `case`: the words that complete the option's value."""
    values = (*option.words, *(stems(data, option.folder) if option.folder else ()))
    offered = "; ".join(
        [*([words(values, option.mark)] if values else []), *([files(option.files)] if option.files else [])])
    begin = f"-{option.letter} | " if option.letter else ""
    reply = f"mapfile -t COMPREPLY < <({offered}); " if offered else ""
    return f"    {begin}--{option.name}) {reply}return ;;"


def stems(data, folder):
    return sorted(path.stem for path in (data / folder).glob("*.json"))


def of_command(name, new_parser):
    """A row of `case`: another command of trax-eval has options of its own, and files."""
    names = sorted(name for name in new_parser()._option_string_actions
                   if name.startswith("--"))  # argparse offers no other way
    return (f"      {name}) if [[ $word == -* ]]; then mapfile -t COMPREPLY < <({words(names)}); "
            f"else mapfile -t COMPREPLY < <({files('f')}); fi; return ;;")


def script(data, experiments):
    """experiments: their names."""
    return SCRIPT % ("\n".join(of_command(*command) for command in COMMANDS.items()), "\n".join(
        value_of(option, data) for option in OPTIONS if option.argument), words(
            f"--{option.name}" for option in OPTIONS), f"{words([*experiments, 'space', *COMMANDS])}; {files('f')}")
