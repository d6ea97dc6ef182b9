// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Words where there is room for a few lines only.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace quadrille
{

/// The words in at most so many lines, at least one, with a line break where each is full. Where there are more of them
/// the last line ends with an ellipsis. fits: whether there is room for a text in a line; a word that has none gets a
/// line of its own.
std::string fittedWords(
  const std::string& text, std::size_t lines, const std::function<bool(const std::string&)>& fits);

} // namespace quadrille
