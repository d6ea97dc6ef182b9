// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "QuadrilleClientLoader.h"

#if defined(__unix__) || defined(__APPLE__)
#include "vtkObject.h"

#include <dlfcn.h>

#include <string>
#endif

void quadrilleLoadClient()
{
#if defined(__unix__) || defined(__APPLE__)
  const bool hasWindow = dlsym(RTLD_DEFAULT, "_ZN17pqApplicationCore8instanceEv") != nullptr;
  Dl_info here;
  if (!hasWindow || dladdr(reinterpret_cast<void*>(&quadrilleLoadClient), &here) == 0)
  {
    return;
  }
  const std::string plugin = here.dli_fname;
  const std::string library =
    plugin.substr(0, plugin.find_last_of('/') + 1) + "Client/QuadrilleClient.so";
  void* client = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
  using Start = void (*)();
  const auto start =
    client ? reinterpret_cast<Start>(dlsym(client, "quadrilleStartClient")) : nullptr;
  if (!start)
  {
    vtkGenericWarningMacro("The drawing tools of Quadrille cannot be loaded from "
      << library << ": " << dlerror()
      << ". Build or install the plugin again, with this ParaView's Qt.");
    return;
  }
  start();
#endif
}
