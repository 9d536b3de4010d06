//===- FileCalls.h - What LLVM reads and writes --------------------------===//
//
// LLVM and clang open their outputs in some thirty places, each with an option of its own, and none compares them with
// what was read. All of them call open and rename of the C library. FileCalls.cpp stands there, so that the one rule of
// outputs (trax/output.h) holds for every option, also for those that nobody here has thought of:
//   - what is opened for reading is noted as an input;
//   - what is opened for writing under its own name is collected in memory, and written by commitOutputs;
//   - what is renamed to its name after it was written is written by trax_write_whole.
// A failure is told by commitOutputs, not by the call. The functions of emulator/base, which write by that rule, use
// renameat and unlinkat, which are as they were.
//
//===----------------------------------------------------------------------===//
#ifndef TRAX_FILES_FILECALLS_H
#define TRAX_FILES_FILECALLS_H

namespace trax {

/// Whether the rule is followed from now on, as it is at first. For other targets clang behaves as it does elsewhere:
/// its modules, for example, are inputs and outputs.
void followRule(bool Follow);

/// What was opened for writing until now.
const void *outputsSoFar();

/// Writes what was collected since then, unless the program has failed (Keep is false), and reports what could not be
/// written as "PROGRAM: error: ...". Returns false if there was any.
bool commitOutputs(const char *Program, bool Keep, const void *Since = nullptr);

} // namespace trax

#endif
