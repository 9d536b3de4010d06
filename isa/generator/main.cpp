//===- main.cpp - trax-isa-gen: C tables and the manual from the ISA description ---===//
//
// A TableGen backend. Reads isa/Isa.td, the description that LLVM's own backends read too, and prints one of:
//   -gen=instructions  TRAX_INSTRUCTION(...) a line for each instruction
//   -gen=units         TRAX_UNIT(...) a line for each unit
//   -gen=numbers       constants of special registers, traps and fences, names of registers
//   -gen=semantics     TRAX_SEMANTICS(NAME, { statement })
//   -gen=codec         the decoder's and the encoder's cases
//   -gen=manual        docs/isa.md, from the template given by -template
//
//===----------------------------------------------------------------------===//

#include "llvm/TableGen/Main.h"
#include "Isa.h"
#include "trax/version.h"
#include "llvm/Support/CommandLine.h"
#include "llvm/Support/InitLLVM.h"

using namespace llvm;

enum class Output { Instructions, Units, Numbers, Semantics, Codec, Manual };

static cl::opt<Output> What("gen", cl::desc("What to print:"), cl::Required,
                            cl::values(clEnumValN(Output::Instructions, "instructions", "Instruction table"),
                                       clEnumValN(Output::Units, "units", "Unit table"),
                                       clEnumValN(Output::Numbers, "numbers", "Named numbers"),
                                       clEnumValN(Output::Semantics, "semantics", "Semantics in C"),
                                       clEnumValN(Output::Codec, "codec", "Decoder and encoder"),
                                       clEnumValN(Output::Manual, "manual", "The manual")));
static cl::opt<std::string> Template("template", cl::desc("Template of the manual"));

static bool emit(raw_ostream &OS, RecordKeeper &Records) {
  trax::Isa Isa = trax::readIsa(Records);
  switch (What) {
  case Output::Instructions:
    trax::emitInstructions(OS, Isa);
    break;
  case Output::Units:
    trax::emitUnits(OS, Isa);
    break;
  case Output::Numbers:
    trax::emitNumbers(OS, Isa);
    break;
  case Output::Semantics:
    trax::emitSemantics(OS, Isa);
    break;
  case Output::Codec:
    trax::emitCodec(OS, Isa);
    break;
  case Output::Manual:
    trax::emitManual(OS, Isa, Template);
    break;
  }
  return false;
}

int main(int argc, char **argv) {
  InitLLVM X(argc, argv);
  cl::SetVersionPrinter([](raw_ostream &OS) { OS << "trax-isa-gen " TRAX_VERSION "\n"; });
  cl::ParseCommandLineOptions(argc, argv, "C tables and the manual from the ISA description\n");
  return TableGenMain(argv[0], &emit);
}
