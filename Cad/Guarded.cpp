// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Cad/Guarded.h"

#include "Base/Error.h"

#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <Standard_Failure.hxx>
#include <TCollection_AsciiString.hxx>

namespace quadrille
{

namespace
{

/// Open CASCADE prints by itself; here it is kept.
class KeptMessages : public Message_Printer
{
public:
  const std::string& text() const { return text_; }

protected:
  void send(const TCollection_AsciiString& message, const Message_Gravity gravity) const override
  {
    if (gravity >= Message_Fail)
    {
      text_ += std::string(message.ToCString()) + "\n";
    }
  }

private:
  mutable std::string text_;
};

/// While it is there, messages go to a printer of ours alone.
class MessageScope
{
public:
  MessageScope() : before_(Message::DefaultMessenger()->Printers())
  {
    Message::DefaultMessenger()->ChangePrinters().Clear();
    Message::DefaultMessenger()->AddPrinter(kept_);
  }
  MessageScope(const MessageScope&) = delete;
  MessageScope& operator=(const MessageScope&) = delete;
  ~MessageScope() { Message::DefaultMessenger()->ChangePrinters() = before_; }

  const std::string& text() const { return kept_->text(); }

private:
  Message_SequenceOfPrinters before_;
  Handle(KeptMessages) kept_ = new KeptMessages;
};

std::string described(const Standard_Failure& failure)
{
  const char* text = failure.GetMessageString();
  const std::string type = failure.DynamicType()->Name();
  return text && *text ? type + ": " + text : type;
}

} // namespace

std::mutex& occtMutex()
{
  static std::mutex mutex;
  return mutex;
}

std::string guarded(const std::string& what, const std::function<void()>& work)
{
  const std::lock_guard<std::mutex> lock(occtMutex());
  const MessageScope messages;
  try
  {
    work();
  }
  catch (const Standard_Failure& failure)
  {
    throw InvalidInput(what + ": Open CASCADE gives up (" + described(failure) + ")");
  }
  return messages.text();
}

} // namespace quadrille
