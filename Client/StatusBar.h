// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Words to the user at the lower end of ParaView's window.
#pragma once

#include <QString>

namespace quadrille
{

/// Shows a word for half a minute.
void say(const QString& text);

} // namespace quadrille
