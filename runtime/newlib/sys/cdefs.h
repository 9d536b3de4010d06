/* Included by newlib's complex functions, which need nothing of it. */
