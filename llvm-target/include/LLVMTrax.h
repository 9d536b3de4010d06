/* Registers the TRaX target with LLVM. Programs that link the static library LLVMTrax call these once at start-up. */
#ifndef LLVMTRAX_H
#define LLVMTRAX_H

#ifdef __cplusplus
extern "C" {
#endif

void LLVMInitializeTraxTargetInfo(void);
void LLVMInitializeTraxTarget(void);
void LLVMInitializeTraxTargetMC(void);
void LLVMInitializeTraxAsmPrinter(void);
void LLVMInitializeTraxAsmParser(void);
void LLVMInitializeTraxDisassembler(void);

/* All of the above. */
static inline void LLVMInitializeTrax(void) {
  LLVMInitializeTraxTargetInfo();
  LLVMInitializeTraxTarget();
  LLVMInitializeTraxTargetMC();
  LLVMInitializeTraxAsmPrinter();
  LLVMInitializeTraxAsmParser();
  LLVMInitializeTraxDisassembler();
}

#ifdef __cplusplus
}
#endif
#endif
