//===- TraxTargetInfo.h - The target's registration ----------------------===//
#ifndef TRAX_TARGETINFO_TRAXTARGETINFO_H
#define TRAX_TARGETINFO_TRAXTARGETINFO_H

namespace llvm {

class Target;
class Triple;

Target &getTheTraxTarget();

/// Whether \p TT names this target. LLVM's Triple does not know "trax", so that every unknown architecture finds this
/// target in the registry: a front end asks here before it accepts the answer.
bool isTraxTriple(const Triple &TT);

} // namespace llvm

#endif
