# SPDX-License-Identifier: MIT
"""What the talk of 21 March 2007 reports, as far as it could be read: the figures that ours stand beside.
None: not known to us. Source: Morales, Nocedal, Smelyanskiy, "An algorithm for the fast solution of symmetric
linear complementarity problems", talk, and Numer. Math. 111 (2008) 251-266."""

# Rows 1 to 10 of its tables: inequalities and equations are ours to name n_b and n_a.
SIZES = [(7, 18), (8, 45), (8, 48), (235, 1044), (449, 1821), (907, 5832), (948, 7344), (966, 8220), (976, 8745),
         (977, 9534)]
NONZEROS = {1: 162, 10: 494118}
CONDITION = {1: "58", 2: "2.9e3", 3: "2.4e3", 4: "4.6e4", 5: "4.2e4", 6: "5.1e7", 10: "1.03e8"}
# PSOR sweeps to a relative error of 1e-1 and 1e-2; its omega is not known.
PSOR = {1: ("4", "6"), 9: ("7184", "> 50,000")}
# Share of the active set that is found after so many sweeps, in percent.
ACTIVE = {2: {6: 83, 7: 82, 8: 91, 9: 80, 10: 92}, 10000: {6: 97, 7: 93, 8: 97, 9: 92, 10: 98}}
# CPU seconds of the interior point method and of PGS+SM, on a machine of 2007.
CPU = {6: (0.50, 0.22), 10: (4.67, 0.87)}
FACTORISATIONS = "17 to 19 for the interior point method, 6 to 9 for PGS+SM"
