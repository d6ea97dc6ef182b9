// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Cad/Calls.h"

#include "Base/Refuse.h"

#include <dlfcn.h>

namespace quadrille
{

namespace
{

const CadCalls* opened()
{
  Dl_info here{};
  refuseIf(::dladdr(reinterpret_cast<const void*>(&cadCalls), &here) == 0,
    "CAD files: nobody knows where the module for them is");
  const std::string own = here.dli_fname;
  const std::string path =
    own.substr(0, own.find_last_of('/') + 1) + QUADRILLE_CAD_FOLDER "QuadrilleCad.so";
  // Never closed: shapes, and the settings of Open CASCADE, are its own.
  void* module = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  refuseIf(!module, "CAD files are read by ", path, ", which cannot be loaded: ", ::dlerror(),
    ". Install Quadrille again, with the libraries of Open CASCADE that it was built with");
  using Table = const CadCalls* (*)();
  const auto table = reinterpret_cast<Table>(::dlsym(module, "quadrilleCadCalls"));
  refuseIf(!table, path, " is not the module for CAD files: ", ::dlerror());
  return table();
}

} // namespace

const CadCalls& cadCalls()
{
  static const CadCalls* calls = opened();
  return *calls;
}

} // namespace quadrille
