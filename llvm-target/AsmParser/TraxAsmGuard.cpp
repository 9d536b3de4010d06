//===- TraxAsmGuard.cpp - No input crashes or blocks the assembler -------===//
#include "TraxAsmGuard.h"
#include "llvm/ADT/StringExtras.h"
#include "llvm/MC/MCContext.h"
#include "llvm/MC/MCExpr.h"
#include "llvm/MC/MCParser/AsmLexer.h"
#include "llvm/MC/MCParser/MCAsmParser.h"
#include "llvm/MC/MCStreamer.h"
#include "llvm/MC/MCSymbol.h"
#include "llvm/Support/ErrorHandling.h"
#include "llvm/Support/Signals.h"
#include "llvm/Support/SourceMgr.h"
#include "llvm/Support/raw_ostream.h"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <sys/resource.h>
#include <tuple>
#include <unistd.h>

using namespace llvm;

// --- places, found without allocation: a signal handler uses them ---

namespace {

struct Place {
  StringRef File;
  unsigned Line = 0;
};

const MCAsmParser *Current;
SMLoc LastInFile; // the last statement outside expansions

bool isExpansion(const MemoryBuffer &Buffer) {
  return Buffer.getBufferIdentifier() == "<instantiation>";
}

/// The place of Loc, or the parser's place if Loc is invalid. The place of an expansion is the statement that began it.
Place placeOf(const SourceMgr &Sources, SMLoc Loc) {
  if (!Loc.isValid() && Current)
    Loc = Current->getTok().getLoc();
  unsigned Buffer = Loc.isValid() ? Sources.FindBufferContainingLoc(Loc) : 0;
  if (Buffer && isExpansion(*Sources.getMemoryBuffer(Buffer))) {
    Loc = LastInFile;
    Buffer = Loc.isValid() ? Sources.FindBufferContainingLoc(Loc) : 0;
  }
  if (!Buffer)
    return {};
  const MemoryBuffer *Text = Sources.getMemoryBuffer(Buffer);
  return {Text->getBufferIdentifier(), 1 + unsigned(std::count(Text->getBufferStart(), Loc.getPointer(), '\n'))};
}

// --- crashes ---

constexpr int Signals[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP};
struct sigaction Before[std::size(Signals)];
const char *ProgramName;
bool GuardsAlways;

const char *reason(int Number) {
  if (!Current)
    return Number == SIGABRT ? "the compiler gave up on this input, or memory is full"
                             : "the compiler crashed on this input";
  return Number == SIGFPE    ? "a division in an expression overflows"
         : Number == SIGABRT ? "a number is too large for the assembler, or memory is full"
                             : "an expression is nested too deeply, or refers to itself";
}

void onCrash(int Number) {
  if (!Current && !GuardsAlways) {
    for (size_t I = 0; I < std::size(Signals); I++)
      sigaction(Signals[I], &Before[I], nullptr);
    if (Number == SIGABRT)
      raise(Number);
    return; // the instruction crashes again, for the handler before
  }
  for (const int Other : Signals)
    signal(Other, SIG_DFL);
  char Text[1024] = "";
  const Place At = Current ? placeOf(const_cast<MCAsmParser *>(Current)->getSourceManager(), SMLoc()) : Place();
  int Length = snprintf(Text, sizeof Text, "%s: error: ", ProgramName);
  if (At.Line)
    Length += snprintf(Text + Length, sizeof Text - size_t(Length),
                       "%.*s:%u: ", int(std::min<size_t>(At.File.size(), 500)), At.File.data(), At.Line);
  Length += snprintf(Text + Length, sizeof Text - size_t(Length), "%s\n", reason(Number));
  if (write(STDERR_FILENO, Text, size_t(Length)) != Length)
    _exit(1);
  sys::RunInterruptHandlers(); // removes temporary files
  _exit(1);
}

template <typename Kind> void lower(Kind Resource, rlim_t Most) {
  struct rlimit Limit;
  if (getrlimit(Resource, &Limit) != 0 || Limit.rlim_cur <= Most)
    return;
  Limit.rlim_cur = Most;
  setrlimit(Resource, &Limit);
}

} // namespace

void trax::guardCrashes(const char *Program, bool Always) {
  static char Stack[1 << 16]; // a stack that has overflown cannot be used
  ProgramName = Program;
  GuardsAlways = Always;
  stack_t Alternative = {};
  if (sigaltstack(nullptr, &Alternative) == 0 && Alternative.ss_flags & SS_DISABLE) {
    Alternative = {Stack, 0, sizeof Stack};
    sigaltstack(&Alternative, nullptr);
  }
  struct sigaction Action = {};
  Action.sa_handler = onCrash;
  Action.sa_flags = SA_ONSTACK | SA_NODEFER;
  sigemptyset(&Action.sa_mask);
  for (size_t I = 0; I < std::size(Signals); I++) {
    struct sigaction Earlier;
    sigaction(Signals[I], &Action, &Earlier);
    if (Earlier.sa_handler == onCrash)
      continue;
    Before[I] = Earlier;
    Before[I].sa_flags |= SA_ONSTACK;
  }
  // A failed allocation is handled like a crash. The library prints nothing.
  install_bad_alloc_error_handler([](void *, const char *, bool) { abort(); });
  std::set_new_handler(abort);
  std::set_terminate(abort);
  lower(RLIMIT_STACK, rlim_t(64) << 20); // else endless recursion takes all memory before it crashes
}

void trax::enterParser(const MCAsmParser *Parser) {
  Current = Parser;
  LastInFile = SMLoc();
}

// --- limits ---

void trax::stopAssembly(const SourceMgr *Sources, SMLoc Loc, const Twine &Message) {
  if (!Sources && Current)
    Sources = &const_cast<MCAsmParser *>(Current)->getSourceManager();
  const Place At = Sources ? placeOf(*Sources, Loc) : Place();
  report_fatal_error((At.Line ? At.File + ":" + Twine(At.Line) + ": " : Twine("")) + Message, /*gen_crash_diag=*/false);
}

/// Prints a problem, without its line if that is too long to read: such a line may have thousands of problems.
static void print(const SMDiagnostic &Problem) {
  constexpr size_t LongestLine = 1000;
  if (Problem.getLineContents().size() <= LongestLine || !Problem.getSourceMgr())
    return Problem.print(nullptr, errs());
  const std::string Message = ("column " + Twine(Problem.getColumnNo() + 1) + ": " + Problem.getMessage()).str();
  SMDiagnostic(*Problem.getSourceMgr(), Problem.getLoc(), Problem.getFilename(), Problem.getLineNo(), /*Col=*/-1,
               Problem.getKind(), Message, /*LineStr=*/"", {})
      .print(nullptr, errs());
}

void trax::limitAssembly(SourceMgr &Sources) {
  static unsigned Errors;
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  lower(RLIMIT_DATA, rlim_t(2) << 30);
#endif
  Sources.setDiagHandler([](const SMDiagnostic &Problem, void *) {
    const SourceMgr *From = Problem.getSourceMgr();
    const unsigned Buffer = From && Problem.getLoc().isValid() ? From->FindBufferContainingLoc(Problem.getLoc()) : 0;
    if (Buffer > 1 && From->getParentIncludeLoc(Buffer).isValid())
      From->PrintIncludeStack(From->getParentIncludeLoc(Buffer), errs());
    print(Problem);
    if (Problem.getKind() == SourceMgr::DK_Error && Buffer && isExpansion(*From->getMemoryBuffer(Buffer)) &&
        ++Errors == 200)
      stopAssembly(From, Problem.getLoc(), "too many errors");
  });
}

void trax::limitMessages(MCContext &Context) {
  Context.setDiagnosticHandler(
      [](const SMDiagnostic &Problem, bool, const SourceMgr &, std::vector<const MDNode *> &) { print(Problem); });
}

namespace {

// LLVM parses a million statements in a second, and looks through all expansions at the end of each.
constexpr uint64_t MostExpanded = 2 << 20; // bytes of text from .rept, .irp, .irpc and macros
constexpr unsigned MostExpansions = 1 << 15, MostIncluded = 10000, MostNested = 200;
constexpr double MostSubstituted = 256 << 20; // bytes of one macro's arguments
constexpr int64_t MostRepeated = 1 << 24;     // values of .fill and .dcb

[[noreturn]] void tooMuch(const MCAsmParser &Parser, SMLoc Loc) {
  trax::stopAssembly(&const_cast<MCAsmParser &>(Parser).getSourceManager(), Loc,
                     "the source expands to more than 2 MB, or by more than 32,768 macros and repetitions");
}

bool begins(StringRef Text, StringRef Directive) {
  Text = Text.ltrim(" \t");
  return Text.starts_with_insensitive(Directive) &&
         (Text.size() == Directive.size() || !isAlnum(Text[Directive.size()]));
}

/// The lines after the first one of Text, up to the matching end.
StringRef bodyOf(StringRef Text, std::initializer_list<const char *> Openings,
                 std::initializer_list<const char *> Ends) {
  const size_t Begin = std::min(Text.find('\n'), Text.size() - 1) + 1;
  unsigned Depth = 1;
  for (size_t At = Begin; At < Text.size(); At = std::min(Text.find('\n', At), Text.size() - 1) + 1) {
    const StringRef Rest = Text.substr(At);
    auto Is = [&](const char *Directive) { return begins(Rest, Directive); };
    Depth += any_of(Openings, Is);
    if (any_of(Ends, Is) && --Depth == 0)
      return Text.slice(Begin, At);
  }
  return Text.substr(Begin);
}

size_t longestLine(StringRef Text) {
  size_t Longest = 0;
  for (StringRef Line; !Text.empty(); Longest = std::max(Longest, Line.size()))
    std::tie(Line, Text) = Text.split('\n');
  return Longest;
}

/// The value of the expression that follows, which stays to be parsed; none if it depends on a later definition.
std::optional<int64_t> valueAhead(MCAsmParser &Parser) {
  const SMLoc Begin = Parser.getTok().getLoc();
  const SourceMgr &Sources = Parser.getSourceManager();
  const MCExpr *Value;
  SMLoc End;
  int64_t Number;
  if (Parser.parseExpression(Value, End))
    return std::nullopt;
  const bool Known = Value->evaluateAsAbsolute(Number, Parser.getStreamer().getAssemblerPtr());
  const unsigned Buffer = Sources.FindBufferContainingLoc(Begin);
  static_cast<AsmLexer &>(Parser.getLexer())
      .setBuffer(Sources.getMemoryBuffer(Buffer)->getBuffer(), Begin.getPointer());
  Parser.Lex();
  return Known ? std::optional(Number) : std::nullopt;
}

/// Refuses a cycle of aliases, with its place. The object writer would follow the cycle without end.
void checkAlias(MCAsmParser &Parser, SMLoc Loc) {
  AsmToken Next[2];
  if (Parser.getTok().isNot(AsmToken::Identifier) || Parser.getLexer().peekTokens(Next) != 2 ||
      Next[1].isNot(AsmToken::Identifier))
    return;
  StringRef Name = Next[1].getIdentifier();
  for (unsigned Steps = 0; Steps < 1000; Steps++) {
    if (Name == Parser.getTok().getIdentifier()) {
      Parser.Error(Loc, "an alias of itself");
      return;
    }
    const MCSymbol *Symbol = Parser.getContext().lookupSymbol(Name);
    const auto *Reference =
        Symbol && Symbol->isVariable() ? dyn_cast<MCSymbolRefExpr>(Symbol->getVariableValue(false)) : nullptr;
    if (!Reference)
      return;
    Name = Reference->getSymbol().getName();
  }
}

} // namespace

void trax::AsmLimits::check(const MCAsmParser &Parser, SMLoc Loc) {
  const SourceMgr &Sources = const_cast<MCAsmParser &>(Parser).getSourceManager();
  const unsigned Before = Included;
  for (; SeenBuffers < Sources.getNumBuffers();) {
    const MemoryBuffer *Buffer = Sources.getMemoryBuffer(++SeenBuffers);
    const bool Expansion = isExpansion(*Buffer);
    Expanded += Expansion ? Buffer->getBufferSize() : 0;
    (Expansion ? Expansions : Included)++;
    if (!Expansion)
      File = Buffer->getBuffer();
  }
  if (Loc.getPointer() >= File.begin() && Loc.getPointer() <= File.end())
    LastInFile = Loc;
  if (Expanded > MostExpanded || Expansions > MostExpansions)
    tooMuch(Parser, Loc);
  if (Included == Before)
    return;
  unsigned Depth = 0;
  for (unsigned At = Sources.FindBufferContainingLoc(Loc); At; Depth++) {
    const SMLoc Parent = Sources.getParentIncludeLoc(At);
    At = Parent.isValid() ? Sources.FindBufferContainingLoc(Parent) : 0;
  }
  if (Depth > MostNested || Included > MostIncluded)
    stopAssembly(&Sources, Loc, "files are included more than 200 deep, or more than 10,000 times");
}

void trax::AsmLimits::checkDirective(MCAsmParser &Parser, StringRef Name, SMLoc Loc) {
  const std::string Lower = Name.lower();
  const bool Counted = Lower == ".rept" || Lower == ".rep", Listed = Lower == ".irp" || Lower == ".irpc";
  if (Lower == ".weakref")
    checkAlias(Parser, Loc);
  if (Lower == ".bundle_align_mode" && valueAhead(Parser).value_or(0) > 16)
    stopAssembly(&Parser.getSourceManager(), Loc, "bundles of more than 64 kB");
  const bool Macro = Lower == ".macro",
             Values = Lower == ".fill" || StringRef(Lower).starts_with(".dcb") || StringRef(Lower).starts_with(".ds");
  if (!Counted && !Listed && !Values && !Macro)
    return;
  const SourceMgr &Sources = Parser.getSourceManager();
  const MemoryBuffer *Buffer = Sources.getMemoryBuffer(Sources.FindBufferContainingLoc(Loc));
  const char *Begin = Parser.getTok().getLoc().getPointer();
  const StringRef Text(Begin, size_t(Buffer->getBufferEnd() - Begin)),
      Line = Text.take_until([](char C) { return C == '\n'; });
  if (Macro) { // a call puts its line into the text in many places
    const StringRef Body = bodyOf(Text, {".macro"}, {".endm", ".endmacro"});
    if (Body.size() > 1 << 10 && double(Body.count('\\')) * double(longestLine(Buffer->getBuffer())) > MostSubstituted)
      tooMuch(Parser, Loc);
    return;
  }
  // A list has no more elements than its line has characters.
  const double Count = Listed ? double(Line.size()) : double(valueAhead(Parser).value_or(0));
  if (Values && Count > double(MostRepeated))
    stopAssembly(&Sources, Loc, "more than 16,777,216 values; .skip and .zero have no limit of this kind");
  if (Values)
    return;
  const StringRef Body = bodyOf(Text, {".rept", ".rep", ".irp", ".irpc"}, {".endr"});
  const double Argument = Listed ? double(Line.size()) * double(Body.count('\\')) : 0;
  if (Count * double(Body.size() + 1) + Argument + double(Expanded) > double(MostExpanded))
    tooMuch(Parser, Loc);
}
