// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Session/SessionText.h"

#include "Base/Refuse.h"
#include "Session/SessionJson.h"

#include <limits>

namespace quadrille
{
namespace
{

const char* codeText(StatusCode code)
{
  switch (code)
  {
    case StatusCode::Ok:
      return "ok";
    case StatusCode::Cancelled:
      return "cancelled";
    case StatusCode::Infeasible:
      return "infeasible";
    case StatusCode::NotConverged:
      return "not converged";
    case StatusCode::TooLarge:
      return "too large";
  }
  return "";
}

} // namespace

ConstraintContent contentFromText(const std::string& text)
{
  return contentFromJson(parseJson(text, "the constraint"), "the constraint");
}

void settingsFromText(const std::string& text, RemeshOptions& settings)
{
  SessionJson json = parseJson(text, "the settings");
  if (json.is_object() && json.contains("threads"))
  {
    const SessionJson& threads = json["threads"];
    if (!threads.is_number_unsigned() || threads > std::numeric_limits<int>::max())
    {
      refuse("\"threads\" of the settings must be a whole number, at least 0");
    }
    settings.threads = threads.get<int>();
    json.erase("threads");
  }
  if (json.is_object() && json.contains("memory_limit"))
  {
    const SessionJson& limit = json["memory_limit"];
    settings.memoryLimit.reset();
    if (!limit.is_null() && !limit.is_number())
    {
      refuse("\"memory_limit\" of the settings must be a number of bytes, or null");
    }
    if (limit.is_number())
    {
      settings.memoryLimit = limit.get<double>();
    }
    json.erase("memory_limit");
  }
  settingsFromJson(json, settings, "the settings");
}

std::string settingsText(const RemeshOptions& settings)
{
  return settingsToJson(settings).dump();
}

std::string constraintsText(const Session& session)
{
  SessionJson list = SessionJson::array();
  for (const auto& constraint : session.constraints())
  {
    SessionJson json;
    json["id"] = constraint->id;
    json["revision"] = constraint->revision;
    json.update(contentToJson(constraint->content));
    list.push_back(std::move(json));
  }
  return list.dump();
}

std::string reportText(const SessionReport& report)
{
  SessionJson json;
  json["ok"] = report.status.ok();
  json["status"] = codeText(report.status.code);
  json["message"] = report.status.message;
  json["stages"] = SessionJson::object();
  for (const StageRecord& record : report.stages)
  {
    json["stages"][record.stage] = record.seconds;
  }
  json["reused"] = report.reused;
  json["runs"] = report.runs;
  json["tries"] = SessionJson::object();
  for (std::size_t i = 0; i < kTries; ++i)
  {
    if (report.tries.taken[i] > 0)
    {
      const TryRow& row = tryTable()[i];
      json["tries"][std::string(row.room) + ": " + row.name] = { { "taken", report.tries.taken[i] },
        { "led", report.tries.led[i] } };
    }
  }
  json["stopped"] = report.stopped;
  json["seconds"] = report.seconds;
  json["notices"] = report.notices;
  json["constraints"] = SessionJson::array();
  for (const ConstraintReport& word : report.constraints)
  {
    json["constraints"].push_back({ { "id", word.id }, { "kind", word.kind }, { "text", word.text },
      { "place", { word.place.x(), word.place.y(), word.place.z() } }, { "met", word.isMet },
      { "deviation", word.deviation }, { "deviation_95", word.deviation95 }, { "unit", word.unit },
      { "reason", word.reason }, { "remark", word.remark } });
  }
  return json.dump();
}

std::string comparisonText(const StateComparison& comparison)
{
  SessionJson json;
  json["settings"] = comparison.settings;
  json["only_first"] = comparison.onlyFirst;
  json["only_second"] = comparison.onlySecond;
  json["changed"] = comparison.changed;
  json["results"] = nullptr;
  if (comparison.results)
  {
    const StateComparison::Results& results = *comparison.results;
    json["results"] = { { "quads", { results.quads[0], results.quads[1] } },
      { "irregular", { results.irregular[0], results.irregular[1] } },
      { "distance", results.distance ? SessionJson(*results.distance) : SessionJson(nullptr) },
      { "unmatched", results.unmatched } };
  }
  return json.dump();
}

void changeSettings(Session& session, const std::string& text)
{
  RemeshOptions options = session.settings();
  options.threads = session.threads();
  options.memoryLimit = session.memoryLimit();
  settingsFromText(text, options);
  session.setSettings(options);
  session.setThreads(options.threads);
  session.setMemoryLimit(options.memoryLimit);
}

} // namespace quadrille
