# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""What Scripts/figures/solved_example.py is made of: meshes, shape functions, two problems, CalculiX, and the page."""
