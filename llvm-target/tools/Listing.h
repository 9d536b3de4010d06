//===- Listing.h - The output of trax-objdump ----------------------------===//
#ifndef TRAX_TOOLS_LISTING_H
#define TRAX_TOOLS_LISTING_H

#include "ElfFile.h"
#include <functional>
#include <string>

namespace llvm {
class Target;
class raw_ostream;
} // namespace llvm

namespace trax {

struct ListingOptions {
  bool FileHeader = false, SectionHeaders = false, ProgramHeaders = false;
  bool Symbols = false, Relocations = false, Contents = false;
  bool Disassemble = false;
  bool Data = false;        ///< with Disassemble: data, too
  bool LineNumbers = false; ///< with Disassemble: places in the source
  bool Source = false;      ///< and the lines themselves
  bool Units = false;       ///< and each instruction's unit and latency
  bool Aliases = true;
  bool Words = true;                     ///< the instructions as numbers
  bool Addresses = true;                 ///< in front of instructions
  std::vector<std::string> OnlySections; ///< if not empty
  std::vector<std::string> OnlySymbols;  ///< if not empty, for Disassemble
  uint64_t Start = 0, Stop = UINT64_MAX; ///< addresses, for Disassemble and Relocations

  /// The lines of a source file; nullopt if it cannot be read.
  std::function<std::optional<std::string>(const std::string &Path)> ReadSource;
  /// Receives warnings.
  std::function<void(const std::string &Message)> Warning;
};

/// Prints the parts that Options selects. Bytes need no alignment. After an error, OS holds a part of the listing.
llvm::Error list(const llvm::Target &T, llvm::StringRef Name, llvm::StringRef Bytes, const ListingOptions &Options,
                 llvm::raw_ostream &OS);

/// The part of it that prints instructions (Disassembly.cpp).
llvm::Error disassemble(const llvm::Target &T, const ElfFile &File, const ListingOptions &Options,
                        llvm::raw_ostream &OS);

/// "main+0x8"
void printPlace(llvm::raw_ostream &OS, llvm::StringRef Name, int64_t Offset);
bool isSelected(const Section &S, const ListingOptions &Options);

} // namespace trax

#endif
