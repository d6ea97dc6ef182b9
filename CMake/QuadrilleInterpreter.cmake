# SPDX-FileCopyrightText: The Quadrille maintainers
# SPDX-License-Identifier: BSD-3-Clause
# Whose Python everything here is built for and tested with. Debian's own interpreter has Debian's VTK and NumPy, which
# another python3 on the PATH (that of pyenv or conda, say) does not find; so it is taken unless one is asked for.
# Included before anything looks for Python, as the first find_package(Python3) settles it for the whole build folder.
if(NOT Python3_EXECUTABLE AND EXISTS "/usr/bin/python3")
  set(Python3_EXECUTABLE "/usr/bin/python3" CACHE FILEPATH "The interpreter that has NumPy and the modules of VTK")
endif()
