/* The latency in cycles of an FPDIV/iSQRT unit for results of b bits (special.precision_bits), for two simple designs
   (Ercegovac and Lang, "Digital Arithmetic", 2004). Both take the paper's 8 cycles for 24 bits. The emulator itself
   uses special.latency_cycles; these functions are for studies of error against run time. */
#ifndef TRAX_SPECIAL_LATENCY_H
#define TRAX_SPECIAL_LATENCY_H

/* A digit recurrence of radix 16, four bits per cycle: two bits more than the result has, for rounding, and one cycle
   to normalise and round (chapters 5 and 6). */
static inline unsigned trax_latency_digits(unsigned bits) {
  return (bits + 2 + 3) / 4 + 1;
}

/* A table of 8 bits, two cycles for the table and the rounding, and steps of Newton's iteration, each of which doubles
   the bits in three cycles: two products and a difference (chapter 7). */
static inline unsigned trax_latency_newton(unsigned bits) {
  unsigned cycles = 2;
  for (unsigned precision = 8; precision < bits; precision *= 2)
    cycles += 3;
  return cycles;
}

#endif
