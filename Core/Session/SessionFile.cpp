// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// Sessions in files.
#include "Base/Refuse.h"
#include "Session/SessionData.h"
#include "Session/SessionJson.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace quadrille
{
namespace
{

constexpr const char* kFormat = "quadrille-session";
constexpr int kSessionVersion = 1;

std::string hexText(std::uint64_t number)
{
  std::ostringstream text;
  text << std::hex << number;
  return text.str();
}

SessionJson meshToJson(const SurfaceInput& surface, int threads)
{
  return { { "points", surface.points.size() }, { "polygons", surface.polygonOffsets.size() - 1 },
    { "hash", hexText(surfaceHash(surface, threads)) } };
}

SessionJson stateToJson(const SessionState& state)
{
  SessionJson json;
  json["settings"] = settingsToJson(state.settings);
  json["constraints"] = SessionJson::array();
  for (const auto& constraint : state.constraints)
  {
    json["constraints"].push_back(constraintToJson(*constraint));
  }
  return json;
}

const SessionJson& memberOf(const SessionJson& json, const char* key, const std::string& where)
{
  if (!json.is_object() || !json.contains(key))
  {
    refuse(where, " is damaged: it has no \"", key, "\"");
  }
  return json[key];
}

void requireOnly(
  const SessionJson& json, const std::set<std::string>& keys, const std::string& where)
{
  for (const auto& [key, value] : json.items())
  {
    if (keys.count(key) == 0)
    {
      refuse(where, " has \"", key, "\", which is not known here");
    }
  }
}

/// Ids of an irregular operation that the surface has to have.
void checkResolved(const IrregularEdit& edit, const std::string& name, std::size_t pointCount)
{
  const auto require = [&](Index point, int valence)
  {
    if (point >= pointCount || valence < 2 || valence > 8)
    {
      refuse(name, " names point ", point, " with valence ", valence, ", but there are ",
        pointCount, " points and valences from 2 to 8");
    }
  };
  const auto requireChanges = [&](const std::vector<IrregularEdit::Change>& changes)
  {
    for (const IrregularEdit::Change& change : changes)
    {
      require(change.point, change.before);
      require(change.point, change.after);
    }
  };
  for (const IrregularVertex& vertex : edit.before)
  {
    require(vertex.point, std::clamp(vertex.valence, 2, 8)); // the surface may have others
  }
  for (const HeldVertex& vertex : edit.onFeatures)
  {
    require(vertex.point, 4);
    for (const HeldSector& sector : vertex.sectors)
    {
      if (sector.turns < 1 || !sector.middle.allFinite())
      {
        refuse(name, " has a sector at point ", vertex.point, " with ", sector.turns,
          " quarter turns, but the least is 1, or its direction is not finite");
      }
    }
  }
  requireChanges(edit.changes);
  for (const IrregularEdit::Link& link : edit.upon)
  {
    requireChanges(link.changes);
  }
}

SessionState stateFromJson(
  const SessionJson& json, const SurfaceInput& surface, const std::string& where)
{
  SessionState state;
  requireOnly(json, { "settings", "constraints" }, where);
  settingsFromJson(memberOf(json, "settings", where), state.settings, "\"settings\" of " + where);
  checkOptions(state.settings);
  const SessionJson& constraints = memberOf(json, "constraints", where);
  if (!constraints.is_array())
  {
    refuse("\"constraints\" of ", where, " must be a list");
  }
  std::set<int> ids;
  for (const SessionJson& each : constraints)
  {
    SessionConstraint constraint = constraintFromJson(each, where);
    const std::string name = constraint.name() + " of " + where;
    checkConstraint(constraint.content, name, surface.polygonOffsets.size() - 1);
    if (const auto* edit = std::get_if<IrregularEdit>(&constraint.content))
    {
      checkResolved(*edit, name, surface.points.size());
    }
    if (constraint.id < 1 || !ids.insert(constraint.id).second)
    {
      refuse(where, " has the id ", constraint.id, " twice, or it is below 1");
    }
    state.constraints.push_back(std::make_shared<const SessionConstraint>(std::move(constraint)));
  }
  return state;
}

[[noreturn]] void failOnFile(const char* what, const std::string& path, int error)
{
  throw std::runtime_error(
    std::string(what) + " '" + path + "': " + std::generic_category().message(error));
}

/// A file that is removed unless it took the place of the one it is for.
class ReplacingFile
{
public:
  explicit ReplacingFile(const std::string& path) : path_(path), temporary_(path + ".XXXXXX")
  {
    file_ = mkstemp(temporary_.data());
    if (file_ < 0)
    {
      failOnFile("cannot write beside", path_, errno);
    }
  }
  ~ReplacingFile()
  {
    close();
    if (!temporary_.empty())
    {
      unlink(temporary_.c_str());
    }
  }
  ReplacingFile(const ReplacingFile&) = delete;
  ReplacingFile& operator=(const ReplacingFile&) = delete;

  void write(const std::string& text)
  {
    for (std::size_t done = 0; done < text.size();)
    {
      const ssize_t count = ::write(file_, text.data() + done, text.size() - done);
      if (count < 0 && errno != EINTR)
      {
        failOnFile("cannot write", temporary_, errno);
      }
      done += count > 0 ? static_cast<std::size_t>(count) : 0;
    }
  }
  void replace()
  {
    // mkstemp gives the file to its owner alone; a saved session is as readable as other new files.
    const mode_t mask = umask(0);
    umask(mask);
    if (fchmod(file_, 0666 & ~mask) != 0 || fsync(file_) != 0)
    {
      failOnFile("cannot write", temporary_, errno);
    }
    close();
    if (std::rename(temporary_.c_str(), path_.c_str()) != 0)
    {
      failOnFile("cannot write", path_, errno);
    }
    temporary_.clear();
  }

private:
  void close()
  {
    if (file_ >= 0)
    {
      ::close(file_);
      file_ = -1;
    }
  }

  std::string path_, temporary_;
  int file_ = -1;
};

std::string readFile(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  if (!file)
  {
    failOnFile("cannot read", path, errno);
  }
  std::ostringstream text;
  text << file.rdbuf();
  if (file.bad())
  {
    failOnFile("cannot read", path, errno);
  }
  return text.str();
}

void requireSameMesh(
  const SessionJson& mesh, const SurfaceInput& surface, int threads, const std::string& where)
{
  const SessionJson given = meshToJson(surface, threads);
  if (mesh == given)
  {
    return;
  }
  refuse(where, " belongs to another surface: it is for ", mesh.dump(), ", but this one is ",
    given.dump(), "; load the surface that it was made with, points and polygons in their order");
}

} // namespace

void Session::save(const std::string& path) const
{
  SessionJson json;
  json["format"] = kFormat;
  json["version"] = kSessionVersion;
  json["mesh"] = meshToJson(data_->surface, data_->limits.threads);
  json["next_id"] = data_->nextId;
  json["state"] = stateToJson(data_->now());
  json["named_states"] = SessionJson::object();
  for (const auto& [name, state] : data_->names)
  {
    json["named_states"][name] = stateToJson(*state);
  }
  ReplacingFile file(path);
  file.write(json.dump(1) + "\n");
  file.replace();
}

Session Session::load(const std::string& path, SurfaceInput surface)
{
  const std::string where = "'" + path + "'";
  const SessionJson json = parseJson(readFile(path), where);
  if (!json.is_object() || json.value("format", SessionJson()) != kFormat)
  {
    refuse(where, " is no file of a session");
  }
  const SessionJson& version = memberOf(json, "version", where);
  if (version != kSessionVersion)
  {
    refuse(where, " is of version ", version.dump(), ", but only version ", kSessionVersion,
      " can be read here");
  }
  requireOnly(json, { "format", "version", "mesh", "next_id", "state", "named_states" }, where);
  auto data = std::make_unique<SessionData>(std::move(surface));
  requireSameMesh(memberOf(json, "mesh", where), data->surface, data->limits.threads, where);
  data->history.front() = std::make_shared<SessionState>(
    stateFromJson(memberOf(json, "state", where), data->surface, where));
  const SessionJson& names = memberOf(json, "named_states", where);
  if (!names.is_object())
  {
    refuse("\"named_states\" of ", where, " must be an object");
  }
  int lastId = 0;
  const auto countIds = [&](const SessionState& state)
  {
    for (const auto& constraint : state.constraints)
    {
      lastId = std::max(lastId, constraint->id);
    }
  };
  countIds(data->now());
  for (const auto& [name, state] : names.items())
  {
    std::string place = "state '";
    place.append(name).append("' of ").append(where);
    data->names[name] = std::make_shared<SessionState>(stateFromJson(state, data->surface, place));
    countIds(*data->names[name]);
  }
  const SessionJson& next = memberOf(json, "next_id", where);
  if (!next.is_number_integer() || next.get<std::int64_t>() <= lastId ||
    next.get<std::int64_t>() > std::numeric_limits<int>::max())
  {
    refuse(where, " is damaged: \"next_id\" is ", next.dump(), ", but ids go up to ", lastId);
  }
  data->nextId = next.get<int>();
  return Session(std::move(data));
}

} // namespace quadrille
