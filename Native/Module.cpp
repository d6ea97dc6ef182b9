// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Export/OutputFile.h"
#ifdef QUADRILLE_WITH_CAD
#include "Native/CadCall.h"
#endif
#include "Native/Errors.h"
#include "Native/Files.h"
#include "Native/RemeshCall.h"
#include "Native/SessionCall.h"
#include "Native/SizesCall.h"

#include <exception>

namespace py = pybind11;

namespace
{

/// An exception of the package's own file of errors.
void raise(const char* name, const std::exception& error)
{
  PyErr_SetString(py::module_::import("quadrille._errors").attr(name).ptr(), error.what());
}

void translate(std::exception_ptr raised)
{
  try
  {
    if (raised)
    {
      std::rethrow_exception(raised);
    }
  }
  catch (const quadrille::InvalidInput& error)
  {
    raise("InvalidInput", error);
  }
  catch (const quadrille::WriteError& error)
  {
    PyErr_SetString(PyExc_OSError, error.what());
  }
  catch (const quadrille::Cancelled&)
  {
    raise("RemeshError", std::runtime_error("stopped on request"));
  }
  catch (const quadrille::native::RunFailure& error)
  {
    raise("RemeshError", error);
  }
}

} // namespace

PYBIND11_MODULE(_native, module)
{
  py::register_exception_translator(translate);
  module.attr("__version__") = QUADRILLE_VERSION;
  module.def("remesh", &quadrille::native::remeshCall);
  quadrille::native::bindSession(module);
  quadrille::native::bindFiles(module);
  quadrille::native::bindSizes(module);
#ifdef QUADRILLE_WITH_CAD
  quadrille::native::bindCad(module);
#endif
}
