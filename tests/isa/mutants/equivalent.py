"""Mutants that no signature can show, by name (a pattern of the shell), and why."""

EQUIVALENT = []
