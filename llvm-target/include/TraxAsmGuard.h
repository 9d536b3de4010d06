//===- TraxAsmGuard.h - No input crashes or blocks the assembler ---------===//
//
// LLVM's assembler has no limits: nested expressions overflow its stack, numbers in directives are sizes of what it
// allocates, and a line of text can expand to any amount of work. The guard turns a crash into an error with its place,
// and the limits stop what grows without end. Both hold for files and for inline assembly.
//
//===----------------------------------------------------------------------===//
#ifndef TRAX_ASMGUARD_H
#define TRAX_ASMGUARD_H

#include "llvm/ADT/StringRef.h"
#include "llvm/ADT/Twine.h"
#include "llvm/Support/SMLoc.h"

namespace llvm {
class MCAsmParser;
class MCContext;
class SourceMgr;
} // namespace llvm

namespace trax {

/// Handles crashes of this process from now on. A crash while assembly is parsed, or any crash if Always, is reported
/// as "PROGRAM: error: ..." and ends the process with status 1. Others go to the previous handler.
void guardCrashes(const char *Program, bool Always);

/// Sets the innermost parser of assembly. A crash is reported with its place.
void enterParser(const llvm::MCAsmParser *Parser);

/// Ends the process by LLVM's fatal error, with the place of Loc in a file. Without Sources, it is the parser's place.
[[noreturn]] void stopAssembly(const llvm::SourceMgr *Sources, llvm::SMLoc Loc, const llvm::Twine &Message);

/// For a process that assembles one file: at most 200 errors in expansions, and 2 GB of memory.
void limitAssembly(llvm::SourceMgr &Sources);

/// Leaves lines that are too long out of messages about labels and the like, as limitAssembly does for the others.
void limitMessages(llvm::MCContext &Context);

/// The expansions of one run of a parser.
class AsmLimits {
  unsigned SeenBuffers = 0;
  uint64_t Expanded = 0;
  unsigned Expansions = 0, Included = 0;
  llvm::StringRef File; // the one that was included last

public:
  /// Called before each instruction and directive.
  void check(const llvm::MCAsmParser &Parser, llvm::SMLoc Loc);
  /// Called before a directive that repeats something: checks its count and the text after its line.
  void checkDirective(llvm::MCAsmParser &Parser, llvm::StringRef Name, llvm::SMLoc Loc);
};

} // namespace trax

#endif
