// The ISA as the generator sees it: plain structs read from TableGen's records.
#ifndef TRAX_ISA_GENERATOR_H
#define TRAX_ISA_GENERATOR_H

#include "llvm/Support/raw_ostream.h"
#include "llvm/TableGen/Record.h"
#include <string>
#include <vector>

namespace trax {

struct Field {
  std::string Name; // rd, ra, rb, imm, offset
  unsigned Low;     // lowest bit in the instruction
  unsigned Width;
};

struct Unit {
  std::string Record, Name, Description;
  int64_t Latency;
};

struct Instruction {
  std::string Name, Mnemonic, Syntax, AssemblerText, Format, Unit, Semantics, Manual;
  uint32_t Mask = 0, Match = 0;
  std::vector<Field> Fields; // most significant first
  bool ImmSigned = false;
  unsigned ImmScale = 1;
  int64_t ImmFirst = 0, ImmLimit = -1;
  unsigned AccessBytes = 0;
  unsigned GroupA = 1, GroupB = 1;
  bool ReadsRA = false, ReadsRB = false, ReadsRD = false, WritesRD = false;
  bool IsLoad = false, IsStore = false, IsAtomic = false, IsNontemporal = false, IsBranch = false, IsFlop = false;
  bool IsRelative = false, IsCompare = false, IsConversion = false, IsRoot = false;

  unsigned opcode() const { return Match >> 26; }
};

struct Format {
  std::string Name, Description;
};

struct Register {
  unsigned Number, DwarfNumber;
  std::string Name, OtherName;
};

// An operand that is written by name and encoded as a number.
struct Numbers {
  std::string List, Prefix;
  std::vector<std::string> Names;
  int64_t First;
};

// Another name for an instruction, or for a sequence. Both as assembler text, the expansion in backquotes.
struct Alias {
  std::string Syntax, Expansion;
  bool IsPrinted; // by the disassembler
};

struct Isa {
  std::vector<Unit> Units;
  std::vector<Format> Formats;     // in the order of their first instructions
  std::vector<Register> Registers; // by number
  std::vector<Alias> Aliases;
  std::vector<Numbers> Named;
  std::vector<Instruction> Instructions; // in the order of their encodings
};

std::vector<Alias> readAliases(llvm::RecordKeeper &Records);
Isa readIsa(llvm::RecordKeeper &Records); // fails with the record's location on an inconsistent description

void emitInstructions(llvm::raw_ostream &OS, const Isa &Isa);
void emitUnits(llvm::raw_ostream &OS, const Isa &Isa);
void emitNumbers(llvm::raw_ostream &OS, const Isa &Isa);
void emitSemantics(llvm::raw_ostream &OS, const Isa &Isa);
void emitCodec(llvm::raw_ostream &OS, const Isa &Isa);
void emitManual(llvm::raw_ostream &OS, const Isa &Isa, const std::string &TemplatePath);
// Parts of the manual.
void drawWord(llvm::raw_ostream &OS, const Instruction &I);
void emitFormats(llvm::raw_ostream &OS, const Isa &Isa);
void emitOpcodes(llvm::raw_ostream &OS, const Isa &Isa);
void emitSpecialCases(llvm::raw_ostream &OS);
void emitRounding(llvm::raw_ostream &OS);
void emitConversions(llvm::raw_ostream &OS);
void emitReducedPrecision(llvm::raw_ostream &OS);

} // namespace trax
#endif
