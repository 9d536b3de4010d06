//===- trax-objdump.cpp - Lists objects, archives and programs -----------===//
//
//   trax-objdump program                            its instructions, with symbols
//   trax-objdump -S --disassemble-symbols=main p    those of one function, with the source
//   trax-objdump -h -t -r a.o                       sections, symbols and relocations
//
// The options are llvm-objdump's. Options are read here; Listing.cpp and Disassembly.cpp print.
//
//===----------------------------------------------------------------------===//
#include "ArchiveFile.h"
#include "Listing.h"
#include "ToolSupport.h"
#include "llvm/Support/CommandLine.h"
#include "llvm/Support/FileSystem.h"
#include "llvm/Support/MemoryBuffer.h"
#include "llvm/Support/WithColor.h"
#include "llvm/Support/raw_ostream.h"

using namespace llvm;

static cl::OptionCategory Listed("What is listed");
static cl::OptionCategory Shown("How instructions are shown");
static cl::OptionCategory Limits("Which part is listed");

static cl::list<std::string> Inputs(cl::Positional, cl::OneOrMore, cl::desc("<object, archive or program>..."),
                                    cl::cat(Listed));

#define FLAG(VARIABLE, NAME, CATEGORY, DESCRIPTION)                                                                    \
  static cl::opt<bool> VARIABLE(NAME, cl::desc(DESCRIPTION), cl::cat(CATEGORY));
#define SHORT_FLAG(VARIABLE, LETTER, LONG, CATEGORY, DESCRIPTION)                                                      \
  FLAG(VARIABLE, LONG, CATEGORY, DESCRIPTION)                                                                          \
  static cl::alias VARIABLE##Short(LETTER, cl::desc("Alias for --" LONG), cl::aliasopt(VARIABLE), cl::Grouping,        \
                                   cl::NotHidden, cl::cat(CATEGORY));

SHORT_FLAG(Disassemble, "d", "disassemble", Listed,
           "Instructions of all code; without another option, this one is taken")
SHORT_FLAG(DisassembleAll, "D", "disassemble-all", Listed, "Instructions, and data in hexadecimal")
SHORT_FLAG(FileHeaders, "f", "file-headers", Listed, "The kind of file and where it starts")
SHORT_FLAG(SectionHeaders, "h", "section-headers", Listed, "The sections")
SHORT_FLAG(LineNumbers, "l", "line-numbers", Shown,
           "With the instructions, places in the source (compile with -g); implies -d")
SHORT_FLAG(ProgramHeaders, "p", "private-headers", Listed, "The program headers")
SHORT_FLAG(Relocations, "r", "reloc", Listed, "The relocations; with -d, below what they change")
SHORT_FLAG(Contents, "s", "full-contents", Listed, "The bytes of the sections")
SHORT_FLAG(Source, "S", "source", Shown, "With the instructions, lines of the source; implies -d")
SHORT_FLAG(Symbols, "t", "syms", Listed, "The symbols")
SHORT_FLAG(AllHeaders, "x", "all-headers", Listed, "The same as -f -p -h -t -r")
FLAG(NoAliases, "no-aliases", Shown, "Every instruction under its own mnemonic")
FLAG(NoLeadingAddr, "no-leading-addr", Shown, "No addresses in front of instructions")
FLAG(NoShowRawInsn, "no-show-raw-insn", Shown, "No instructions as numbers")
FLAG(Units, "units", Shown, "With each instruction, the unit that executes it and its latency")

static cl::list<std::string> OnlySections("section", cl::desc("Only these sections"), cl::value_desc("name"),
                                          cl::CommaSeparated, cl::cat(Limits));
static cl::alias OnlySectionsShort("j", cl::desc("Alias for --section"), cl::aliasopt(OnlySections), cl::NotHidden,
                                   cl::cat(Limits));
static cl::list<std::string> OnlySymbols("disassemble-symbols",
                                         cl::desc("Only the instructions of these functions; implies -d"),
                                         cl::value_desc("name"), cl::CommaSeparated, cl::cat(Limits));
static cl::opt<uint64_t> StartAddress("start-address", cl::desc("No instructions or relocations below this address"),
                                      cl::value_desc("address"), cl::init(0), cl::cat(Limits));
static cl::opt<uint64_t> StopAddress("stop-address", cl::desc("None at this address or above"),
                                     cl::value_desc("address"), cl::init(UINT64_MAX), cl::cat(Limits));
static cl::list<std::string> PrinterOptions("M", cl::desc("Printer option: no-aliases"), cl::value_desc("option"),
                                            cl::CommaSeparated, cl::cat(Shown));

static void warn(const std::string &Message) {
  WithColor::warning(errs(), "trax-objdump") << Message << '\n';
}

/// A path in debug information can be anything: read regular files only, of a size that a source can have.
static std::optional<std::string> readSource(const std::string &Path) {
  sys::fs::file_status Status;
  if (sys::fs::status(Path, Status) || !sys::fs::is_regular_file(Status) || Status.getSize() > (64u << 20))
    return std::nullopt;
  ErrorOr<std::unique_ptr<MemoryBuffer>> Buffer = MemoryBuffer::getFile(Path, /*IsText=*/true);
  if (!Buffer)
    return std::nullopt;
  return (*Buffer)->getBuffer().str();
}

static trax::ListingOptions readOptions() {
  trax::ListingOptions Options;
  Options.FileHeader = FileHeaders || AllHeaders;
  Options.ProgramHeaders = ProgramHeaders || AllHeaders;
  Options.SectionHeaders = SectionHeaders || AllHeaders;
  Options.Symbols = Symbols || AllHeaders;
  Options.Relocations = Relocations || AllHeaders;
  Options.Contents = Contents;
  bool IsOther = Options.FileHeader || Options.ProgramHeaders || Options.SectionHeaders || Options.Symbols ||
                 Options.Relocations || Contents;
  Options.Disassemble = !IsOther || Disassemble || DisassembleAll || LineNumbers || Source || !OnlySymbols.empty();
  Options.Data = DisassembleAll;
  Options.LineNumbers = LineNumbers;
  Options.Source = Source;
  Options.Units = Units;
  Options.Aliases = !NoAliases;
  for (const std::string &Option : PrinterOptions)
    if (Option == "no-aliases")
      Options.Aliases = false;
    else
      trax::fail("unknown printer option '" + Option + "' (-M knows no-aliases)");
  Options.Words = !NoShowRawInsn;
  Options.Addresses = !NoLeadingAddr;
  Options.OnlySections = OnlySections;
  Options.OnlySymbols = OnlySymbols;
  Options.Start = StartAddress;
  Options.Stop = StopAddress;
  Options.ReadSource = readSource;
  Options.Warning = warn;
  return Options;
}

static Error listFile(const Target &T, StringRef Name, StringRef Bytes, const trax::ListingOptions &Options) {
  std::string Text;
  raw_string_ostream OS(Text);
  if (Error E = trax::list(T, Name, Bytes, Options, OS))
    return createStringError(inconvertibleErrorCode(), "'" + Name + "': " + toString(std::move(E)));
  outs() << '\n' << OS.str();
  return Error::success();
}

static Error listArchive(const Target &T, StringRef Path, StringRef Bytes, const trax::ListingOptions &Options) {
  Error MemberError = Error::success();
  Error E = trax::forEachMember(Bytes, [&](StringRef Name, StringRef Contents) {
    MemberError = joinErrors(std::move(MemberError), listFile(T, (Path + "(" + Name + ")").str(), Contents, Options));
    return Error::success();
  });
  if (E)
    E = createStringError(inconvertibleErrorCode(), "'" + Path + "': " + toString(std::move(E)));
  return joinErrors(std::move(MemberError), std::move(E));
}

int main(int Argc, char **Argv) {
  cl::HideUnrelatedOptions({&Listed, &Shown, &Limits});
  const Target &T = trax::startTool(Argc, Argv, "TRaX program listing\n");
  trax::ListingOptions Options = readOptions();
  bool Good = true;
  for (const std::string &Path : Inputs) {
    ErrorOr<std::unique_ptr<MemoryBuffer>> Buffer = MemoryBuffer::getFileOrSTDIN(Path);
    Error E = Error::success();
    if (std::error_code EC = Buffer.getError())
      E = createStringError(EC, "'" + Path + "': " + EC.message());
    else if (StringRef Bytes = (*Buffer)->getBuffer(); trax::isArchive(Bytes))
      E = joinErrors(std::move(E), listArchive(T, Path, Bytes, Options));
    else
      E = joinErrors(std::move(E), listFile(T, Path, Bytes, Options));
    handleAllErrors(std::move(E), [&](const ErrorInfoBase &Info) {
      outs().flush();
      WithColor::error(errs(), "trax-objdump") << Info.message() << '\n';
      Good = false;
    });
  }
  outs().flush();
  if (std::error_code EC = outs().error()) {
    outs().clear_error();
    trax::fail("cannot write: " + EC.message());
  }
  return trax::endTool(Good ? 0 : 1);
}
