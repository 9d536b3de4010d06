//===- TraxNumbers.td - names that are encoded as numbers ----------------===//
//
// The only lists of special registers, traps and fences. To add one, append a word to its list and add a row to
// isa.md.in that explains it. The assembler, the disassembler, the C constants (trax/numbers.h, which <trax.h> and
// trax/abi.h include), the builtins' functions and the conformance suite follow.

// Names are in the order of their numbers. PREFIX_NAME is the constant in C. Numbers from Limit on are illegal.
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
