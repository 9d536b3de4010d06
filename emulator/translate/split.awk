# Divides the templates of templates.c, compiled to assembly: what follows the first jump to the next instruction is the
# cold part, in a section of its own. A size across sections cannot be assembled, and nobody needs it.
/^[ \t]*\.size/ { next }
/^trax_(template|burst)_[A-Za-z0-9_]*:/ { name = part = $1; sub(/:.*/, "", part) }
/# state/ { state[name] = 1 }
/%(rbx|ebx|bx|bl|bh|r14|r15)/ && !/# state/ { other[name] = 1 }
{ print }
part != "" && /^[ \t]*jmp[ \t]+trax_goes_on/ { print "\t.section .text.cold_" part ",\"ax\",@progbits"; part = "" }
END {
  for (name in other)
    if (name in state) {
      print name " uses rbx, r14 or r15" > "/dev/stderr"
      failed = 1
    }
  exit failed
}
