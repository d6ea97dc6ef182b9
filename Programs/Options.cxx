// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Options.h"

#include "Terminal.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <numeric>
#include <sstream>
#include <utility>

namespace quadrille
{

namespace
{

/// Columns of the help, and where the texts of the options begin.
constexpr std::size_t kHelpWidth = 116;
constexpr std::size_t kTextColumn = 28;

template <class Number>
Number parseNumber(const std::string& name, const std::string& text, Range<Number> range,
  const std::string& before = "")
{
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || end != text.data() + text.size() ||
    !(value >= range.least && value <= range.most))
  {
    std::ostringstream message;
    message << "--" << name << " needs " << before << "a number from " << range.least << " to "
            << range.most << ", not '" << text << "'";
    throw UsageError(message.str());
  }
  return value;
}

/// "a, b or c".
std::string listed(const std::vector<std::string>& words)
{
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
  {
    text += (i == 0 ? "" : i + 1 < words.size() ? ", " : " or ") + words[i];
  }
  return text;
}

/// Insertions, deletions and exchanges of letters that lead from one word to the other.
std::size_t editDistance(const std::string& a, const std::string& b)
{
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{ 0 });
  for (std::size_t i = 1; i <= a.size(); ++i)
  {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j)
    {
      const std::size_t kept = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({ row[j] + 1, row[j - 1] + 1, kept });
    }
  }
  return row.back();
}

[[noreturn]] void refuseOption(const std::string& word, const std::vector<std::string>& names)
{
  const std::string name = word.substr(std::min(word.find_first_not_of('-'), word.size()));
  const std::string bare = name.substr(0, name.find('='));
  const auto nearest = std::min_element(names.begin(), names.end(),
    [&](const std::string& a, const std::string& b)
    { return editDistance(bare, a) < editDistance(bare, b); });
  const bool similar =
    nearest != names.end() && 2 * editDistance(bare, *nearest) <= nearest->size();
  throw UsageError("unknown option " + word +
    (similar ? "; did you mean --" + *nearest + "?" : "; --help lists all options"));
}

/// Groups under their own texts, nothing that CLI11 would add.
class HelpText : public CLI::Formatter
{
public:
  /// CLI11's names of groups have no line breaks: they are places in these texts.
  explicit HelpText(const std::vector<std::string>& groups) : groups_(groups) {}

  std::string make_help(const CLI::App* app, std::string, CLI::AppFormatMode mode) const override
  {
    return app->get_description() + make_groups(app, mode) + "\n" + app->get_footer() + "\n";
  }
  std::string make_group(
    std::string group, bool positional, std::vector<const CLI::Option*> options) const override
  {
    std::string text = groups_.at(std::stoul(group)) + "\n";
    for (const CLI::Option* option : options)
    {
      text += make_option(option, positional);
    }
    return text;
  }

private:
  const std::vector<std::string>& groups_;
};

} // namespace

struct CommandOptions::Parser
{
  std::vector<std::string> groups;
  CLI::App app;
  std::vector<std::string> files;
  std::vector<std::string> names;
  std::vector<std::string> flags; ///< those of the names that take no value
  bool askedForVersion = false;

  std::string groupName() const { return std::to_string(groups.size() - 1); }

  void describe(CLI::Option* option, const std::string& name)
  {
    option->group(groupName());
    names.push_back(name);
  }

  /// An option with one value, given once at most, or, with mayRepeat, several times.
  void addValue(const std::string& name, const std::string& unit,
    std::function<void(const std::string&)> use, const std::string& help, bool mayRepeat = false)
  {
    CLI::Option* option = app.add_option(
      "--" + name,
      [name, use, mayRepeat](const CLI::results_t& values)
      {
        if (values.size() > 1 && !mayRepeat)
        {
          throw UsageError("--" + name + " is given twice");
        }
        std::for_each(values.begin(), values.end(), use);
        return true;
      },
      wrapText(help, kHelpWidth - kTextColumn, 0));
    option->type_name(unit)->type_size(1)->expected(1)->multi_option_policy(
      CLI::MultiOptionPolicy::TakeAll);
    describe(option, name);
  }

  /// CLI11 takes "--quiet=" and "--help=no" for answers.
  void refuseValuesOfFlags(int argc, char* argv[]) const
  {
    for (int i = 1; i < argc; ++i)
    {
      const std::string word = argv[i];
      const std::string begin = word.substr(0, word.find('='));
      const auto isBegin = [&begin](const std::string& name) { return begin == "--" + name; };
      if (begin != word && std::any_of(flags.begin(), flags.end(), isBegin))
      {
        throw UsageError(begin + " takes no value");
      }
    }
  }

  /// Throws UsageError in our words for what CLI11 cannot parse.
  void parse(int argc, char* argv[])
  {
    refuseValuesOfFlags(argc, argv);
    try
    {
      app.parse(argc, argv);
    }
    catch (const CLI::CallForHelp&)
    {
      return;
    }
    catch (const CLI::ArgumentMismatch& error)
    {
      const std::string text = error.what(); // "--name: what is wrong"
      throw UsageError(text.substr(0, text.find(':')) + " needs a value");
    }
    catch (const CLI::ParseError& error)
    {
      throw UsageError(error.what());
    }
    const std::vector<std::string> unknown = app.remaining();
    if (!unknown.empty())
    {
      refuseOption(unknown.front(), names);
    }
  }
};

CommandOptions::CommandOptions(const std::string& introduction, const std::string& closing)
  : parser_(std::make_unique<Parser>())
{
  CLI::App& app = parser_->app;
  app.description(introduction);
  app.footer(closing);
  app.formatter(std::make_shared<HelpText>(parser_->groups));
  app.get_formatter()->column_width(kTextColumn);
  app.allow_extras(); // so that the message is ours
  app.set_help_flag();
  app.add_option("files", parser_->files);
}

CommandOptions::~CommandOptions() = default;

void CommandOptions::beginGroup(const std::string& text)
{
  parser_->groups.push_back(text);
}

void CommandOptions::addNumber(const std::string& name, const std::string& unit,
  Range<double> range, std::function<void(double)> set, const std::string& help)
{
  parser_->addValue(
    name, unit, [=](const std::string& word) { set(parseNumber(name, word, range)); }, help);
}

void CommandOptions::addCount(const std::string& name, const std::string& unit,
  Range<long long> range, std::function<void(long long)> set, const std::string& help)
{
  parser_->addValue(
    name, unit, [=](const std::string& word) { set(parseNumber(name, word, range)); }, help);
}

void CommandOptions::addCountOrWord(const std::string& name, const std::string& unit,
  Range<long long> range, const std::string& word,
  std::function<void(std::optional<long long>)> set, const std::string& help)
{
  const auto choose = [=](const std::string& given)
  {
    set(
      given == word ? std::nullopt : std::optional(parseNumber(name, given, range, word + " or ")));
  };
  parser_->addValue(name, unit, choose, help);
}

void CommandOptions::addChoice(const std::string& name, const std::string& unit,
  const std::vector<std::string>& words, std::function<void(int)> set, const std::string& help)
{
  const auto choose = [=](const std::string& word)
  {
    const auto found = std::find(words.begin(), words.end(), word);
    if (found == words.end())
    {
      throw UsageError("--" + name + " needs " + listed(words) + ", not '" + word + "'");
    }
    set(static_cast<int>(found - words.begin()));
  };
  parser_->addValue(name, unit, choose, help);
}

void CommandOptions::addText(const std::string& name, const std::string& unit,
  std::function<void(const std::string&)> set, const std::string& help)
{
  parser_->addValue(name, unit, std::move(set), help);
}

void CommandOptions::addTexts(const std::string& name, const std::string& unit,
  std::function<void(const std::string&)> set, const std::string& help)
{
  parser_->addValue(name, unit, std::move(set), help, true);
}

void CommandOptions::addFlag(
  const std::string& name, std::function<void()> set, const std::string& help)
{
  CLI::Option* option = parser_->app.add_flag_callback(
    "--" + name, std::move(set), wrapText(help, kHelpWidth - kTextColumn, 0));
  parser_->describe(option, name);
  parser_->flags.push_back(name);
}

std::optional<std::string> CommandOptions::parse(int argc, char* argv[])
{
  CLI::App& app = parser_->app;
  const CLI::Option* askedForHelp =
    app.set_help_flag("--help,-h", "this text")->group(parser_->groupName());
  addFlag(
    "version", [this] { parser_->askedForVersion = true; }, "the version of this program");
  parser_->names.push_back("help");
  parser_->flags.push_back("help");
  try
  {
    parser_->parse(argc, argv);
  }
  catch (const UsageError&)
  {
    // Who asks for help may not know yet what is wrong.
    if (askedForHelp->count() == 0)
    {
      throw;
    }
  }
  if (askedForHelp->count() > 0)
  {
    return help();
  }
  return parser_->askedForVersion ? std::optional<std::string>("Quadrille " QUADRILLE_VERSION "\n")
                                  : std::nullopt;
}

const std::vector<std::string>& CommandOptions::files() const
{
  return parser_->files;
}

bool CommandOptions::given(const std::string& name) const
{
  return parser_->app.count("--" + name) > 0;
}

std::string CommandOptions::help() const
{
  return parser_->app.help();
}

void addMethod(CommandOptions& options, std::function<void(int)> set, const std::string& help)
{
  options.addChoice("method", "NAME", { "scale-aware", "mixed-integer", "quadcover", "seamless" },
    std::move(set), help);
}

} // namespace quadrille
