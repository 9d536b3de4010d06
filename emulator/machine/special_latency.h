/* Cycles that an FPDIV/iSQRT unit takes for results of b bits (special.precision_bits), by two plain designs, both of
   which take the paper's 8 cycles for 24 bits (Ercegovac and Lang, "Digital Arithmetic", 2004). The emulator itself
   takes special.latency_cycles as it is; these are for studies of error against run time. */
#ifndef TRAX_MACHINE_SPECIAL_LATENCY_H
#define TRAX_MACHINE_SPECIAL_LATENCY_H

/* A recurrence of radix 16, four bits a cycle: two bits more than the result for its rounding, and a cycle to normalise
   and round (chapters 5 and 6). */
static inline unsigned trax_latency_digits(unsigned bits) {
  return (bits + 2 + 3) / 4 + 1;
}

/* A table of 8 bits, read and rounded, and steps of Newton's iteration, each of which doubles the bits with two
   products and a difference (chapter 7). */
static inline unsigned trax_latency_newton(unsigned bits) {
  unsigned cycles = 2;
  for (unsigned so_far = 8; so_far < bits; so_far *= 2)
    cycles += 3;
  return cycles;
}

#endif
