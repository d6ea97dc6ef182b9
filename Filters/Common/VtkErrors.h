// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What VTK's own readers and writers report, as text.
#pragma once

#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkNew.h>
#include <vtkObject.h>

#include <string>

namespace quadrille
{

/// Collects what a VTK object reports as errors instead of letting it print them.
class ErrorCollector
{
public:
  explicit ErrorCollector(vtkObject* object)
  {
    callback_->SetClientData(&text_);
    callback_->SetCallback([](vtkObject*, unsigned long, void* client, void* data)
      { *static_cast<std::string*>(client) += firstLine(static_cast<const char*>(data)); });
    object->AddObserver(vtkCommand::ErrorEvent, callback_);
  }
  const std::string& text() const { return text_; }
  /// Without the mark behind the last one.
  std::string sentence() const
  {
    return text_.size() > 2 ? text_.substr(0, text_.size() - 2) : text_;
  }

private:
  /// VTK's messages: "ERROR: In file, line n\nvtkClass (0x...): what is wrong\n\n".
  static std::string firstLine(const char* message)
  {
    std::string text = message ? message : "";
    const std::size_t body = text.find("): ");
    if (body != std::string::npos)
    {
      text = text.substr(body + 3);
    }
    return text.substr(0, text.find('\n')) + "; ";
  }

  vtkNew<vtkCallbackCommand> callback_;
  std::string text_;
};

} // namespace quadrille
