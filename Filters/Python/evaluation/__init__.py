# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""The evaluation of the method [Ebke et al. 2016, Sections 8 and 9], and of any quad mesh: what the command
quadrille-evaluate runs. Needs numpy, scipy and matplotlib."""
