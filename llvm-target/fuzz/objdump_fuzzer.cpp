//===- objdump_fuzzer.cpp - trax-objdump under libFuzzer -----------------===//
//
// A case is a line of words, each of which selects a part of the listing, and files, which are listed one by one.
//
//===----------------------------------------------------------------------===//
#include "ArchiveFile.h"
#include "LLVMTrax.h"
#include "Listing.h"
#include "fuzz_case.h"
#include "llvm/MC/TargetRegistry.h"
#include "llvm/Support/raw_ostream.h"

using namespace llvm;

static const Target &target() {
  static const Target *T = [] {
    LLVMInitializeTrax();
    std::string Message;
    return TargetRegistry::lookupTarget("trax", Message);
  }();
  return *T;
}

/// An unknown word selects nothing, so every line is valid.
static void apply(StringRef Word, trax::ListingOptions &Options) {
  if (Word == "-f")
    Options.FileHeader = true;
  else if (Word == "-h")
    Options.SectionHeaders = true;
  else if (Word == "-p")
    Options.ProgramHeaders = true;
  else if (Word == "-t")
    Options.Symbols = true;
  else if (Word == "-r")
    Options.Relocations = true;
  else if (Word == "-s")
    Options.Contents = true;
  else if (Word == "-d")
    Options.Disassemble = true;
  else if (Word == "-D")
    Options.Disassemble = Options.Data = true;
  else if (Word == "-l")
    Options.Disassemble = Options.LineNumbers = true;
  else if (Word == "-S")
    Options.Disassemble = Options.Source = true;
  else if (Word == "-x")
    Options.FileHeader = Options.ProgramHeaders = Options.SectionHeaders = Options.Symbols = Options.Relocations = true;
  else if (Word == "--units")
    Options.Units = true;
  else if (Word == "--no-aliases")
    Options.Aliases = false;
  else if (Word.consume_front("-j"))
    Options.OnlySections.push_back(Word.str());
  else if (Word.consume_front("--disassemble-symbols="))
    Options.OnlySymbols.push_back(Word.str());
  else if (Word.consume_front("--start-address="))
    Word.getAsInteger(0, Options.Start);
  else if (Word.consume_front("--stop-address="))
    Word.getAsInteger(0, Options.Stop);
}

int LLVMFuzzerTestOneInput(const uint8_t *Bytes, size_t Size) {
  fuzz_case Case;
  fuzz_case_read(&Case, Bytes, Size);
  trax::ListingOptions Options;
  char *Words[FUZZ_MAX_OPTIONS / 2 + 1];
  for (size_t I = 0, Count = fuzz_case_words(Case.options, Words, FUZZ_MAX_OPTIONS / 2 + 1); I != Count; ++I)
    apply(Words[I], Options);
  Options.ReadSource = [](const std::string &) { return std::optional<std::string>("one\ntwo\r\n\nfour"); };
  Options.Warning = [](const std::string &) {};
  for (const fuzz_file &File : ArrayRef(Case.files, Case.file_count)) {
    StringRef Contents(reinterpret_cast<const char *>(File.bytes), File.size);
    auto List = [&](StringRef Name, StringRef Member) {
      consumeError(trax::list(target(), Name, Member, Options, nulls()));
      return Error::success();
    };
    consumeError(trax::isArchive(Contents) ? trax::forEachMember(Contents, List) : List(File.name, Contents));
  }
  fuzz_case_free(&Case);
  return 0;
}

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t *Bytes, size_t Size, size_t Capacity, unsigned Seed) {
  static const char Words[] = "-f -h -p -t -r -s -d -D -l -S -x --units --no-aliases -j.text -j.data -jextra "
                              "--disassemble-symbols=f --start-address=8 --stop-address=0x1010";
  return fuzz_case_mutate(Bytes, Size, Capacity, Seed, Words);
}
