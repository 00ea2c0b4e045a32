"""The paper's three discs, by the factor on the baseline's heights."""

# The scene of each, which is also the name of its run without time acceleration.
SCENES = {"1": "baseline", "0.1": "heights-10", "0.01": "heights-100"}
# As figures and tables have them.
NAMES = {"1": "baseline", "0.1": "heights / 10", "0.01": "heights / 100"}
