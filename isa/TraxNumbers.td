//===- TraxNumbers.td - what is written by name and encoded as a number --===//
//
// Special registers, traps, fences: the only place where they are listed. A new one is a word at the end
// of its list and a row of isa.md.in that says what it does. Assembler, disassembler, C constants (trax/numbers.h, which
// <trax.h> and trax/abi.h include), the builtins' functions and the conformance suite follow.

// Names stand in the order of their numbers. PREFIX_NAME is the constant in C; Limit is the first number that is illegal.
class TraxNumbers<string macro, string prefix, list<string> names, int first = 0> {
  string List = macro;
  string Prefix = prefix;
  list<string> Names = names;
  int First = first;
  int Limit = !add(first, !size(names));
}

def SpecialRegisters : TraxNumbers<"TRAX_SPECIAL_REGISTERS", "TRAX_SR", ["thread", "tm", "tp", "threads", "cycle", "cycleh"]>;
def Traps : TraxNumbers<"TRAX_TRAPS", "TRAX_TRAP", ["exit", "putc", "abort", "rays", "items", "puts", "kinds", "host"]>;
def Fences : TraxNumbers<"TRAX_FENCES", "TRAX_FENCE", ["r", "w", "rw"], 1>; // bits: rw is both

class NumberOf<TraxNumbers numbers, string name> {
  int Number = !foldl(numbers.First, !range(numbers.Names), sum, i, !if(!eq(numbers.Names[i], name), !add(sum, i), sum));
}
