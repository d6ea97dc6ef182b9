// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Cad/Calls.h"

#include "Base/Refuse.h"

#include <dlfcn.h>

#include <filesystem>

namespace quadrille
{

namespace
{

/// In the folder of the library that this function is in; where it was built into a program and into a module of
/// Python, from the next folder above that has it.
std::string modulePath(std::filesystem::path folder)
{
  const std::filesystem::path name = QUADRILLE_CAD_FOLDER "QuadrilleCad.so";
  const std::string here = (folder / name).string();
  std::error_code code;
  while (!std::filesystem::exists(folder / name, code) && folder.has_relative_path())
  {
    folder = folder.parent_path();
  }
  return std::filesystem::exists(folder / name, code) ? (folder / name).string() : here;
}

const CadCalls* opened()
{
  Dl_info here{};
  refuseIf(::dladdr(reinterpret_cast<const void*>(&cadCalls), &here) == 0,
    "CAD files: nobody knows where the module for them is");
  std::filesystem::path own = here.dli_fname;
  if (!own.has_parent_path()) // a program by the name that it was called by
  {
    own = std::filesystem::read_symlink("/proc/self/exe");
  }
  const std::string path =
    modulePath(std::filesystem::absolute(own).lexically_normal().parent_path());
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
