//===- ToolSupport.cpp - Common parts of the command-line tools ----------===//
#include "ToolSupport.h"
#include "FileCalls.h"
#include "LLVMTrax.h"
#include "TraxAsmGuard.h"
#include "trax/files.h"
#include "trax/message.h"
#include "trax/output.h"
#include "trax/version.h"
#include "llvm/MC/TargetRegistry.h"
#include "llvm/Support/CommandLine.h"
#include "llvm/Support/ErrorHandling.h"
#include "llvm/Support/Path.h"
#include "llvm/Support/WithColor.h"
#include "llvm/Support/raw_ostream.h"

#include <unistd.h>

using namespace llvm;

static std::string ToolName = "trax";

const Target &trax::startTool(int Argc, char **Argv, StringRef Overview) {
  ToolName = sys::path::filename(Argv[0]).str();
  LLVMInitializeTrax();
  guardCrashes(ToolName.c_str(), /*Always=*/true);
  install_fatal_error_handler([](void *, const char *Message, bool) { fail(Message); });
  WithColor::setAutoDetectFunction(
      [](const raw_ostream &OS) { return trax_has_colours(&OS == &outs() ? STDOUT_FILENO : STDERR_FILENO); });
  cl::SetVersionPrinter(
      [](raw_ostream &OS) { OS << ToolName << " " TRAX_VERSION " (TRaX toolchain), LLVM " LLVM_VERSION_STRING "\n"; });
  cl::ParseCommandLineOptions(Argc, Argv, Overview);
  std::string Message;
  const Target *T = TargetRegistry::lookupTarget("trax", Message);
  if (!T)
    fail(Message);
  return *T;
}

void trax::fail(const Twine &Message) {
  WithColor::error(errs(), ToolName) << Message << '\n';
  exit(1);
}

void trax::checkFiles(ArrayRef<std::string> Inputs, const std::string &Output) {
  trax_files Files = {};
  trax_error Reason;
  for (const std::string &Input : Inputs)
    trax_files_input(&Files, nullptr, Input.c_str());
  trax_files_output(&Files, "-o", Output.c_str());
  const trax_status Status = trax_files_check(&Files, &Reason);
  trax_files_release(&Files);
  if (Status != TRAX_OK)
    fail(Reason.message);
}

void trax::writeOutput(const std::string &File, StringRef Bytes) {
  trax_error Reason;
  if (trax_write_file(File.c_str(), Bytes.data(), Bytes.size(), &Reason) != TRAX_OK)
    fail(Reason.message);
}

int trax::endTool(int Status) {
  return commitOutputs(ToolName.c_str(), Status == 0) ? Status : 1;
}
