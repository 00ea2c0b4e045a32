"""Readings of the local rule that no scene has, by their names, as rule.steps has them: how debris is shared (0: the pin first, 1: as
a_p to a_d), and up to where the disc fills (0: its highest initial level, 1: the disc ahead, 2: the pin ahead)."""

READINGS = {"the rule as it stands": (0, 0), "shared as a_p to a_d": (1, 0), "disc up to the disc ahead": (0, 1), "disc up to the pin ahead": (0, 2)}
# Sets of surfaces of every choice.
SEEDS = (1, 2, 3)
