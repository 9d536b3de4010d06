//===- TraxCallingConv.td - Arguments and results (docs/abi.md) ----------===//

// Large aggregates stay in memory even if registers are free.
def CC_Trax_Common : CallingConv<[
  CCIfByVal<CCPassByVal<4, 4>>,
  CCIfType<[i1, i8, i16], CCPromoteToType<i32>>
]>;

def CC_Trax : CallingConv<[
  CCDelegateTo<CC_Trax_Common>,
  CCIfType<[i32, f32], CCAssignToReg<[R4, R5, R6, R7, R8, R9, R10, R11]>>,
  CCAssignToStack<4, 4>
]>;

// Arguments beyond the named ones of a variadic function.
def CC_Trax_Unnamed : CallingConv<[
  CCDelegateTo<CC_Trax_Common>,
  CCAssignToStack<4, 4>
]>;

def RetCC_Trax : CallingConv<[
  CCIfType<[i1, i8, i16], CCPromoteToType<i32>>,
  CCIfType<[i32, f32], CCAssignToReg<[R4, R5, R6, R7]>>
]>;

// The order is that of the frame: ra and fp on top.
def CSR_None : CalleeSavedRegs<(add)>;
def CSR : CalleeSavedRegs<(add R1, R3, (sequence "R%u", 20, 31))>;
