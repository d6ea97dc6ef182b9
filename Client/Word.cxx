// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Word.h"

#include "FittedWords.h"

#include "pqCoreUtilities.h"

#include <QFontMetrics>
#include <QLabel>
#include <QResizeEvent>
#include <QTimer>
#include <QToolBar>

#include <algorithm>

namespace quadrille
{
namespace
{

constexpr int kMessageTime = 30000; // milliseconds
constexpr int kMargin = 8;          // pixels
constexpr const char* kName = "QuadrilleWord";

QString inOneLine(const QString& first, const QString& second)
{
  return first.isEmpty() || second.isEmpty() ? first + second : first + ' ' + second;
}

class Words : public QLabel
{
public:
  explicit Words(QWidget* parent) : QLabel(parent)
  {
    this->setObjectName(kName);
    this->setTextFormat(Qt::PlainText);
    this->setWordWrap(true); // or the bar would be as wide as the longest line
    this->setContentsMargins(kMargin, 0, 0, 0);
    this->setSizePolicy(
      QSizePolicy::Expanding, QSizePolicy::Ignored); // the bar stays as high as its buttons
    this->Timer.setSingleShot(true);
    this->Timer.setInterval(kMessageTime);
    QObject::connect(&this->Timer, &QTimer::timeout, this, [this] { this->say({}); });
  }

  const QString& said() const { return this->Said; }

  void say(const QString& text)
  {
    this->Said = text;
    this->Timer.start();
    this->refresh();
  }

  void sayProgress(const QString& text)
  {
    this->Progress = text;
    this->refresh();
  }

protected:
  void resizeEvent(QResizeEvent* event) override
  {
    this->QLabel::resizeEvent(event);
    this->refresh();
  }

private:
  void refresh()
  {
    const QString text = inOneLine(this->Progress, this->Said);
    const QRect room = this->contentsRect();
    const QFontMetrics letters(this->font());
    const std::string fitted = fittedWords(text.toStdString(),
      static_cast<std::size_t>(std::max(1, room.height() / letters.lineSpacing())),
      [&](const std::string& line)
      { return letters.horizontalAdvance(QString::fromStdString(line)) < room.width(); });
    if (this->text().toStdString() != fitted)
    {
      this->setText(QString::fromStdString(fitted));
    }
    this->setToolTip(text);
  }

  QString Progress, Said;
  QTimer Timer;
};

Words* words()
{
  QWidget* window = pqCoreUtilities::mainWidget();
  return window ? static_cast<Words*>(window->findChild<QLabel*>(kName)) : nullptr;
}

} // namespace

void addRoomForWords(QToolBar* bar)
{
  bar->addWidget(new Words(bar));
}

void say(const QString& text)
{
  if (Words* label = words())
  {
    label->say(text);
  }
}

void sayOutcome(const QString& text)
{
  if (Words* label = words())
  {
    label->say(inOneLine(text, label->said()));
  }
}

void sayProgress(const QString& text)
{
  if (Words* label = words())
  {
    label->sayProgress(text);
  }
}

} // namespace quadrille
