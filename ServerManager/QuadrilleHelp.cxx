// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "QuadrilleHelp.h"

#if defined(__unix__) || defined(__APPLE__)
#include <dlfcn.h>
#endif

namespace quadrille
{

void allowHelpPages()
{
#if defined(__unix__) || defined(__APPLE__)
  static bool done = false;
  if (done) // each proxy of ours asks
  {
    return;
  }
  // The plugin is loaded by pvserver and pvpython, too, which may run where there is no Qt: so it is not linked with
  // it, and the four functions are looked for among what the process has, by the names that compilers give them.
  using GetPointer = void* (*)();
  using GetPointerOf = void* (*)(void*);
  using SetFlagOf = void (*)(void*, bool);
  using SetUp = bool (*)(void*);
  const auto application =
    reinterpret_cast<GetPointer>(dlsym(RTLD_DEFAULT, "_ZN17pqApplicationCore8instanceEv"));
  const auto helpEngine =
    reinterpret_cast<GetPointerOf>(dlsym(RTLD_DEFAULT, "_ZN17pqApplicationCore10helpEngineEv"));
  const auto setReadOnly =
    reinterpret_cast<SetFlagOf>(dlsym(RTLD_DEFAULT, "_ZN15QHelpEngineCore11setReadOnlyEb"));
  const auto setUp = // again, as the collection was opened for reading
    reinterpret_cast<SetUp>(dlsym(RTLD_DEFAULT, "_ZN15QHelpEngineCore9setupDataEv"));
  if (application && helpEngine && setReadOnly && setUp && application())
  {
    if (void* engine = helpEngine(application()))
    {
      setReadOnly(engine, false);
      setUp(engine);
      done = true;
    }
  }
#endif
}

} // namespace quadrille
