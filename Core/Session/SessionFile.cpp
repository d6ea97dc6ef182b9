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
#include <map>
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
/// Version 1 had ids of points in place of places of irregular vertices.
constexpr int kSessionVersion = 2;
constexpr int kVersionOfPoints = 1;

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

/// Numbers of an irregular operation that the surface can have.
void checkResolved(const IrregularEdit& edit, const std::string& name, std::size_t pointCount)
{
  const auto require = [&](const Vector3& place, int valence)
  {
    if (!place.allFinite() || valence < kLeastValence || valence > kMostValence)
    {
      refuse(name, " has a place with valence ", valence, ", but there are valences from ",
        kLeastValence, " to ", kMostValence, ", and places have to be finite");
    }
  };
  const auto requireChanges = [&](const std::vector<IrregularEdit::Change>& changes)
  {
    for (const IrregularEdit::Change& change : changes)
    {
      require(change.place, change.before);
      require(change.place, change.after);
    }
  };
  for (const auto* list : { &edit.before, &edit.shown })
  {
    for (const IrregularVertex& vertex : *list)
    {
      // The surface may have others.
      require(vertex.place, std::clamp(vertex.valence, kLeastValence, kMostValence));
    }
  }
  for (const JoinedEnds& joined : edit.joined)
  {
    // 0: a feature or boundary.
    require(joined.start, joined.startValence == 0 ? kRegularValence : joined.startValence);
    require(joined.end, joined.endValence == 0 ? kRegularValence : joined.endValence);
  }
  for (const Vector3& place : edit.withoutMap)
  {
    require(place, kRegularValence);
  }
  for (const HeldVertex& vertex : edit.onFeatures)
  {
    if (vertex.point >= pointCount)
    {
      refuse(name, " names point ", vertex.point, ", but there are ", pointCount, " points");
    }
    require(vertex.place, kRegularValence);
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

/// Places in place of the ids of points that a constraint of version 1 has: that of the vertex with the id, or of the
/// point. What does not fit is left for who reads it.
void putPlaces(SessionJson& constraint, const SurfaceInput& surface, const std::string& where)
{
  if (!constraint.is_object() || !constraint.contains("resolved"))
  {
    return;
  }
  SessionJson& resolved = constraint["resolved"];
  std::map<std::size_t, SessionJson> places;
  const auto idOf = [&](const SessionJson& json)
  {
    const std::size_t id =
      json["point"].is_number_unsigned() ? json["point"].get<std::size_t>() : surface.points.size();
    if (id >= surface.points.size())
    {
      refuse(where, " names point ", json["point"].dump(), ", but there are ",
        surface.points.size(), " points");
    }
    return id;
  };
  const auto forEachWithPoint = [](SessionJson& json, const char* key, const auto& act)
  {
    if (json.is_object() && json.contains(key) && json[key].is_array())
    {
      for (SessionJson& each : json[key])
      {
        if (each.is_object() && each.contains("point"))
        {
          act(each);
        }
      }
    }
  };
  const auto putPlace = [&](SessionJson& change)
  {
    const std::size_t id = idOf(change);
    const auto known = places.find(id);
    const Vector3& p = surface.points[id];
    change["place"] = known != places.end() ? known->second : SessionJson{ p.x(), p.y(), p.z() };
    change.erase("point");
  };
  forEachWithPoint(resolved, "before",
    [&](SessionJson& vertex)
    {
      places[idOf(vertex)] = vertex["place"];
      vertex.erase("point");
    });
  forEachWithPoint(resolved, "changes", putPlace);
  if (resolved.is_object() && resolved.contains("upon") && resolved["upon"].is_array())
  {
    for (SessionJson& link : resolved["upon"])
    {
      forEachWithPoint(link, "changes", putPlace);
    }
  }
}

SessionState stateFromJson(
  const SessionJson& json, int version, const SurfaceInput& surface, const std::string& where)
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
  for (SessionJson each : constraints)
  {
    if (version == kVersionOfPoints)
    {
      putPlaces(each, surface, where);
    }
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
  if (version != kSessionVersion && version != kVersionOfPoints)
  {
    refuse(where, " is of version ", version.dump(), ", but only versions ", kVersionOfPoints,
      " and ", kSessionVersion, " can be read here");
  }
  requireOnly(json, { "format", "version", "mesh", "next_id", "state", "named_states" }, where);
  auto data = std::make_unique<SessionData>(std::move(surface));
  requireSameMesh(memberOf(json, "mesh", where), data->surface, data->limits.threads, where);
  data->history.front() = std::make_shared<SessionState>(
    stateFromJson(memberOf(json, "state", where), version, data->surface, where));
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
    data->names[name] =
      std::make_shared<SessionState>(stateFromJson(state, version, data->surface, place));
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
