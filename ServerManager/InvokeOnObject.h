// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Calls on the object behind a proxy, past its properties.
#ifndef InvokeOnObject_h
#define InvokeOnObject_h

#include "vtkClientServerStream.h"
#include "vtkSMProxy.h"
#include "vtkSMSession.h"

namespace quadrille
{

/// Calls a method with values on the object of the proxy, wherever that is.
template <class... Values>
void invoke(vtkSMProxy* proxy, const char* method, Values... values)
{
  vtkClientServerStream stream;
  stream << vtkClientServerStream::Invoke << VTKOBJECT(proxy) << method;
  static_cast<void>((stream << ... << values));
  stream << vtkClientServerStream::End;
  proxy->GetSession()->ExecuteStream(proxy->GetLocation(), stream);
}

} // namespace quadrille

#endif
