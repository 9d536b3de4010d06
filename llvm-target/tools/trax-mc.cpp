//===- trax-mc.cpp - Assembler and disassembler --------------------------===//
//
//   trax-mc -filetype=obj -o a.o a.s      assembles
//   trax-mc -show-encoding a.s            prints what it read
//   trax-mc -disassemble bytes.txt        prints the instructions of bytes such as "0x00 0x00 0x00 0x20"
//
//===----------------------------------------------------------------------===//
#include "ToolSupport.h"
#include "TraxAsmGuard.h"
#include "llvm/MC/MCAsmBackend.h"
#include "llvm/MC/MCAsmInfo.h"
#include "llvm/MC/MCCodeEmitter.h"
#include "llvm/MC/MCContext.h"
#include "llvm/MC/MCDisassembler/MCDisassembler.h"
#include "llvm/MC/MCInst.h"
#include "llvm/MC/MCInstPrinter.h"
#include "llvm/MC/MCInstrInfo.h"
#include "llvm/MC/MCObjectFileInfo.h"
#include "llvm/MC/MCObjectWriter.h"
#include "llvm/MC/MCParser/MCAsmParser.h"
#include "llvm/MC/MCParser/MCTargetAsmParser.h"
#include "llvm/MC/MCRegisterInfo.h"
#include "llvm/MC/MCStreamer.h"
#include "llvm/MC/MCSubtargetInfo.h"
#include "llvm/MC/MCTargetOptions.h"
#include "llvm/MC/TargetRegistry.h"
#include "llvm/Support/CommandLine.h"
#include "llvm/Support/FormattedStream.h"
#include "llvm/Support/MemoryBuffer.h"
#include "llvm/Support/SourceMgr.h"
#include "llvm/Support/raw_ostream.h"
#include "llvm/TargetParser/Triple.h"

using namespace llvm;

enum class FileType { Assembly, Object };

static cl::OptionCategory Category("Options of trax-mc");

static cl::opt<std::string> Input(cl::Positional, cl::desc("<input file>"), cl::init("-"), cl::cat(Category));
static cl::opt<std::string> Output("o", cl::desc("Output file"), cl::value_desc("file"), cl::init("-"),
                                   cl::cat(Category));
static cl::opt<FileType> Filetype("filetype", cl::desc("What to write:"), cl::cat(Category),
                                  cl::init(FileType::Assembly),
                                  cl::values(clEnumValN(FileType::Assembly, "asm", "assembly"),
                                             clEnumValN(FileType::Object, "obj", "an ELF object")));
static cl::opt<bool> ShowEncoding("show-encoding", cl::desc("Print each instruction's bytes"), cl::cat(Category));
static cl::opt<bool> Disassemble("disassemble", cl::desc("Read bytes, write assembly"), cl::cat(Category));
static cl::list<std::string> PrinterOptions("M", cl::desc("Printer option: no-aliases"), cl::value_desc("option"),
                                            cl::cat(Category));
static cl::list<std::string> IncludeDirs("I", cl::desc("Directory of .include files"), cl::value_desc("dir"),
                                         cl::Prefix, cl::cat(Category));

namespace {

/// The parts of the MC layer, in the order in which they need each other.
struct Machine {
  Triple TT{"trax"};
  MCTargetOptions Options;
  std::unique_ptr<MCRegisterInfo> MRI;
  std::unique_ptr<MCAsmInfo> MAI;
  std::unique_ptr<MCInstrInfo> MII;
  std::unique_ptr<MCSubtargetInfo> STI;
  SourceMgr Sources;
  std::unique_ptr<MCContext> Ctx;
  std::unique_ptr<MCObjectFileInfo> MOFI;

  explicit Machine(const Target &T) {
    Options.ShowMCEncoding = ShowEncoding;
    Options.AsmVerbose = true; // comments: the encodings
    MRI.reset(T.createMCRegInfo(TT.str()));
    MAI.reset(T.createMCAsmInfo(*MRI, TT.str(), Options));
    MAI->setPreserveAsmComments(false);
    MII.reset(T.createMCInstrInfo());
    STI.reset(T.createMCSubtargetInfo(TT.str(), "", ""));
    Sources.setIncludeDirs(IncludeDirs);
    Ctx = std::make_unique<MCContext>(TT, MAI.get(), MRI.get(), STI.get(), &Sources, &Options);
    MOFI.reset(T.createMCObjectFileInfo(*Ctx, /*PIC=*/false));
    Ctx->setObjectFileInfo(MOFI.get());
  }

  MCInstPrinter *createPrinter(const Target &T) const {
    MCInstPrinter *Printer = T.createMCInstPrinter(TT, MAI->getAssemblerDialect(), *MAI, *MII, *MRI);
    for (const std::string &Option : PrinterOptions)
      if (!Printer->applyTargetSpecificCLOption(Option))
        trax::fail("unknown printer option '" + Option + "'");
    return Printer;
  }
};

} // namespace

static std::unique_ptr<MCStreamer> createStreamer(const Target &T, Machine &M, raw_pwrite_stream &OS) {
  std::unique_ptr<MCAsmBackend> Backend(T.createMCAsmBackend(*M.STI, *M.MRI, M.Options));
  std::unique_ptr<MCCodeEmitter> Emitter(T.createMCCodeEmitter(*M.MII, *M.Ctx));
  if (Filetype == FileType::Assembly) {
    if (!ShowEncoding)
      Emitter.reset();
    return std::unique_ptr<MCStreamer>(T.createAsmStreamer(*M.Ctx, std::make_unique<formatted_raw_ostream>(OS),
                                                           M.createPrinter(T), std::move(Emitter), std::move(Backend)));
  }
  std::unique_ptr<MCObjectWriter> Writer = Backend->createObjectWriter(OS);
  return std::unique_ptr<MCStreamer>(
      T.createMCObjectStreamer(M.TT, *M.Ctx, std::move(Backend), std::move(Writer), std::move(Emitter), *M.STI));
}

/// False if the source has errors, which have been reported.
static bool assemble(const Target &T, Machine &M, raw_pwrite_stream &OS) {
  std::unique_ptr<MCStreamer> Streamer = createStreamer(T, M, OS);
  std::unique_ptr<MCAsmParser> Parser(createMCAsmParser(M.Sources, *M.Ctx, *Streamer, *M.MAI));
  std::unique_ptr<MCTargetAsmParser> TargetParser(T.createMCAsmParser(*M.STI, *Parser, *M.MII, M.Options));
  Parser->setTargetParser(*TargetParser);
  return !Parser->Run(/*NoInitialTextSection=*/false);
}

/// Bytes as text, "0x12, 0x34 ..."; '#' starts a comment. Four bytes are one instruction. Bytes that are none are
/// reported.
static bool disassemble(const Target &T, Machine &M, raw_pwrite_stream &OS) {
  std::unique_ptr<MCDisassembler> Decoder(T.createMCDisassembler(*M.STI, *M.Ctx));
  std::unique_ptr<MCInstPrinter> Printer(M.createPrinter(T));
  std::unique_ptr<MCStreamer> Streamer = createStreamer(T, M, OS);
  Streamer->initSections(false, *M.STI);

  const MemoryBuffer &Buffer = *M.Sources.getMemoryBuffer(M.Sources.getMainFileID());
  std::vector<uint8_t> Bytes;
  std::vector<const char *> Places;
  bool Good = true;
  StringRef Text = Buffer.getBuffer();
  while (!Text.empty()) {
    StringRef Line;
    std::tie(Line, Text) = Text.split('\n');
    Line = Line.split('#').first;
    while (!(Line = Line.ltrim(" \t\r,[]")).empty()) {
      StringRef Token = Line.take_until([](char C) { return StringRef(" \t\r,[]").contains(C); });
      unsigned Byte = 0;
      if (Token.getAsInteger(0, Byte) || Byte > 255) {
        M.Sources.PrintMessage(SMLoc::getFromPointer(Token.data()), SourceMgr::DK_Error, "expected a byte");
        Good = false;
      }
      Bytes.push_back(Byte);
      Places.push_back(Token.data());
      Line = Line.drop_front(Token.size());
    }
  }
  if (!Good)
    return false;
  for (uint64_t Index = 0, Size; Index < Bytes.size(); Index += Size) {
    MCInst Inst;
    if (Decoder->getInstruction(Inst, Size, ArrayRef(Bytes).slice(Index), Index, nulls()) == MCDisassembler::Success) {
      Streamer->emitInstruction(Inst, *M.STI);
      continue;
    }
    M.Sources.PrintMessage(SMLoc::getFromPointer(Places[Index]), SourceMgr::DK_Error,
                           Size < 4 ? "less than an instruction is left" : "illegal instruction");
    Good = false;
    Size = std::max<uint64_t>(Size, 1);
  }
  return Good;
}

int main(int Argc, char **Argv) {
  cl::HideUnrelatedOptions(Category);
  const Target &T = trax::startTool(Argc, Argv, "TRaX assembler and disassembler\n");
  trax::checkFiles({Input}, Output);
  ErrorOr<std::unique_ptr<MemoryBuffer>> Buffer = MemoryBuffer::getFileOrSTDIN(Input, /*IsText=*/true);
  if (std::error_code EC = Buffer.getError())
    trax::fail("'" + Input + "': " + EC.message());
  if (Disassemble && Filetype == FileType::Object)
    trax::fail("-disassemble writes assembly, not objects");

  Machine M(T);
  trax::limitAssembly(M.Sources);
  trax::limitMessages(*M.Ctx);
  M.Sources.AddNewSourceBuffer(std::move(*Buffer), SMLoc());
  SmallString<0> Bytes;
  raw_svector_ostream OS(Bytes);
  if (!(Disassemble ? disassemble(T, M, OS) : assemble(T, M, OS)))
    return 1;
  trax::writeOutput(Output, Bytes);
  return trax::endTool(0);
}
