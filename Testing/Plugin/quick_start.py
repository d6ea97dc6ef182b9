# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
"""To be imported before paraview.simple, by scripts that nobody asks for help.

More than half of the start of a program would go into the help texts of all filters, of simple and again of LoadPlugin.
"""
from paraview import servermanager

servermanager.ProxyNamespace.getDocumentation = lambda self, name: ""
