// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Session/Session.h"

#include "Base/Clock.h"
#include "Base/Refuse.h"
#include "Mesh/ContentHash.h"
#include "Numerics/MinCostFlow.h"
#include "Pipeline/SizedSurface.h"
#include "Prepare/ConstraintPlacement.h"
#include "Session/IrregularEdits.h"
#include "Session/IrregularMatch.h"
#include "Session/SessionData.h"
#include "Session/SessionJson.h"
#include "Session/StateRun.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace quadrille
{
namespace
{

constexpr std::size_t kResultsShareOfMachine = 32;

void checkSettings(const RemeshOptions& settings)
{
  checkOptions(settings);
  if (settings.smoothingSteps < 0)
  {
    refuse("the number of smoothing steps must be at least 0");
  }
  if (settings.maximumNumberOfQuads < 1)
  {
    refuse("the largest number of quads must be at least 1");
  }
}

std::vector<std::string> settingDifferences(const RemeshOptions& a, const RemeshOptions& b)
{
  const SessionJson first = settingsToJson(a);
  const SessionJson second = settingsToJson(b);
  std::vector<std::string> differences;
  const auto textOf = [](const SessionJson& json, const std::string& key)
  { return json.contains(key) ? json[key].dump() : std::string("none"); };
  for (const auto& [key, value] : first.items())
  {
    if (!second.contains(key) || second[key] != value)
    {
      differences.push_back(key + ": " + value.dump() + ", " + textOf(second, key));
    }
  }
  for (const auto& [key, value] : second.items())
  {
    if (!first.contains(key))
    {
      differences.push_back(key + ": none, " + value.dump());
    }
  }
  return differences;
}

/// The earth mover's distance of the irregular vertices in straight lines.
void measureDistance(
  const SessionResult& first, const SessionResult& second, StateComparison::Results& results)
{
  std::vector<std::pair<Vector3, int>> give,
    take; // quarter turns that are over, and that are missing
  const auto add = [&](const Vector3& place, int index)
  {
    if (index != 0)
    {
      (index > 0 ? give : take).push_back({ place, std::abs(index) });
    }
  };
  std::map<Vector3, int, PlaceOrder> indices;
  for (const IrregularVertex& vertex : first.irregular)
  {
    indices[vertex.place] += kRegularValence - vertex.valence;
  }
  for (const IrregularVertex& vertex : second.irregular)
  {
    indices[vertex.place] -= kRegularValence - vertex.valence;
  }
  for (const auto& [place, index] : indices)
  {
    add(place, index);
  }
  constexpr std::size_t kMostPairs = 4000000;
  if (give.size() * take.size() > kMostPairs)
  {
    return;
  }
  double longest = 0;
  for (const auto& [a, supply] : give)
  {
    for (const auto& [b, demand] : take)
    {
      longest = std::max(longest, (a - b).norm());
    }
  }
  const double scale = longest > 0 ? kUnitsOfLongest / longest : 0;
  MinCostFlow flow(static_cast<Index>(give.size() + take.size()));
  for (std::size_t i = 0; i < give.size(); ++i)
  {
    for (std::size_t k = 0; k < take.size(); ++k)
    {
      flow.addArc(static_cast<Index>(i), static_cast<Index>(give.size() + k),
        std::min(give[i].second, take[k].second),
        std::llround(scale * (give[i].first - take[k].first).norm()));
    }
    flow.addSupply(static_cast<Index>(i), give[i].second);
  }
  for (std::size_t k = 0; k < take.size(); ++k)
  {
    flow.addSupply(static_cast<Index>(give.size() + k), -take[k].second);
  }
  const MinCostFlow::Result solved = flow.solve();
  results.distance = scale > 0 ? static_cast<double>(solved.cost) / scale : 0;
  for (std::size_t i = 0; i < give.size() + take.size(); ++i)
  {
    results.unmatched += std::abs(flow.remaining(static_cast<Index>(i)));
  }
}

} // namespace

std::size_t SessionResult::bytes() const
{
  return bytesOf(quads.points) + bytesOf(quads.quads) + bytesOf(quads.sourceFace) +
    bytesOf(quads.sourceWeights) + bytesOf(quads.quadSourceFace) +
    bytesOf(quads.quadSourceWeights) + bytesOf(quads.valence) + bytesOf(quads.onBoundary) +
    bytesOf(quads.lines) + bytesOf(irregular) + bytesOf(fixed.edges) + bytesOf(fixed.withoutMap) +
    bytesOf(fixed.insideOfFaces) + bytesOf(onFeatures) + bytesOf(joined) + bytesOf(mirrorPoint) +
    bytesOf(rotatedPoint) + sizeof(*this);
}

std::uint64_t surfaceHash(const SurfaceInput& surface, int threads)
{
  KeyMaker key(contentHash(surface, threads));
  for (const Vector3& direction : surface.guideDirections)
  {
    key.add(direction);
  }
  key.add(surface.guideWeights, surface.targetValences);
  for (const CurveRequest& curve : surface.curves)
  {
    key.add(curve.kind);
    for (const Vector3& p : curve.points)
    {
      key.add(p);
    }
  }
  return key.add(surface.regularElsewhere).key();
}

//------------------------------------------------------------------------------
SessionData::SessionData(SurfaceInput input)
  : surface(std::move(input)), results(ResultStore::bytesOfMachine() / kResultsShareOfMachine)
{
  if (surface.polygonPoints.empty())
  {
    refuse("the surface has no polygon");
  }
  requirePolygons(surface);
  history.push_back(std::make_shared<SessionState>());
}

PlacesOfSession SessionData::places(const RemeshOptions& settings)
{
  if (!places_)
  {
    places_ = std::make_unique<SurfacePlaces>(surface, limits.threads);
    paths_ = std::make_unique<SurfacePaths>(surface, limits.threads);
    area_ = areaOfPolygons(surface);
    diagonal_ = diagonalOf(surface.points);
  }
  return { *places_, *paths_, kOnePlace * targetEdgeLength(settings, area_, diagonal_) };
}

void SessionData::keepSurface(std::shared_ptr<const PreparedSurface> made, const Frame& frame)
{
  if (paths_)
  {
    paths_->use(std::move(made), frame);
  }
}

std::shared_ptr<const OnCurves> SessionData::onCurvesOf(const MadeSurface& made)
{
  return findOrMake<OnCurves>(
    &store, made.surface.hash, [&] { return findOnCurves(made, limits.threads); },
    [](const OnCurves& found) { return bytesOf(found.vertices) + bytesOf(found.edges); });
}

std::shared_ptr<SessionResult> SessionData::resultOf(const SessionState& state)
{
  return results.find<SessionResult>(state.key());
}

void SessionData::keep(const SessionState& state, std::shared_ptr<SessionResult> result)
{
  const std::size_t bytes = result->bytes();
  results.put(state.key(), std::move(result), bytes);
}

void SessionData::enter(std::shared_ptr<SessionState> state)
{
  history.resize(at + 1);
  history.push_back(std::move(state));
  at = history.size() - 1;
}

SessionState SessionData::next() const
{
  SessionState state = now();
  state.key_.reset();
  return state;
}

SessionState& SessionData::named(const std::string& name) const
{
  if (name.empty())
  {
    return now();
  }
  const auto found = names.find(name);
  if (found == names.end())
  {
    std::string all;
    for (const auto& [known, state] : names)
    {
      all += (all.empty() ? "" : ", ") + known;
    }
    refuse(
      "there is no state '", name, "'; ", all.empty() ? "none has a name" : "there are: " + all);
  }
  return *found->second;
}

std::vector<IrregularEdit::Link> SessionData::linksInForce() const
{
  IrregularList list;
  for (const auto& constraint : now().constraints)
  {
    if (const auto* edit = std::get_if<IrregularEdit>(&constraint->content))
    {
      list.apply(constraint->id, constraint->revision, *edit);
    }
  }
  return list.links();
}

SessionConstraints::iterator SessionState::find(int id)
{
  const auto found = std::find_if(constraints.begin(), constraints.end(),
    [id](const auto& constraint) { return constraint->id == id; });
  if (found == constraints.end())
  {
    std::string all;
    for (const auto& constraint : constraints)
    {
      all += (all.empty() ? "" : ", ") + std::to_string(constraint->id);
    }
    refuse(
      "there is no constraint ", id, "; ", all.empty() ? "there are none" : "the ids are: " + all);
  }
  return found;
}

ResultKey SessionState::key() const
{
  if (!key_)
  {
    SessionJson json;
    json["settings"] = settingsToJson(settings);
    for (const auto& constraint : constraints)
    {
      json["constraints"].push_back(constraintToJson(*constraint));
    }
    key_ = KeyMaker().add(json.dump()).key();
  }
  return *key_;
}

//------------------------------------------------------------------------------
Session::Session(SurfaceInput surface, RemeshOptions settings)
  : data_(std::make_unique<SessionData>(std::move(surface)))
{
  checkSettings(settings);
  data_->limits = { settings.threads, settings.memoryLimit, settings.progress };
  data_->history.front()->settings = std::move(settings);
}

Session::Session(std::unique_ptr<SessionData> data) : data_(std::move(data)) {}
Session::~Session() = default;
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;

const SurfaceInput& Session::surface() const
{
  return data_->surface;
}

const RemeshOptions& Session::settings() const
{
  return data_->now().settings;
}

void Session::setSettings(const RemeshOptions& settings)
{
  checkSettings(settings);
  if (settingDifferences(data_->now().settings, settings).empty())
  {
    return;
  }
  auto next = std::make_shared<SessionState>(data_->next());
  next->settings = settings;
  data_->enter(std::move(next));
}

int Session::threads() const
{
  return data_->limits.threads;
}

std::optional<double> Session::memoryLimit() const
{
  return data_->limits.memoryLimit;
}

void Session::setThreads(int threads)
{
  data_->limits.threads = threads;
}

void Session::setMemoryLimit(std::optional<double> bytes)
{
  data_->limits.memoryLimit = bytes;
}

void Session::setProgress(ProgressCallback progress)
{
  data_->limits.progress = std::move(progress);
}

int Session::add(ConstraintContent content)
{
  const int id = data_->nextId;
  SessionConstraint constraint{ id, 0, std::move(content) };
  const std::string name = constraint.name();
  checkConstraint(constraint.content, name, data_->surface.polygonOffsets.size() - 1);
  if (auto* edit = std::get_if<IrregularEdit>(&constraint.content))
  {
    update();
    const std::shared_ptr<const SessionResult> now = data_->resultOf(data_->now());
    if (!now || !now->report.status.ok())
    {
      refuse(name, " needs quads whose irregular vertices it changes, but there are none: ",
        now ? now->report.status.message : "the run was stopped");
    }
    const PlacesOfSession where = data_->places(settings());
    const NearestQuads quads(now->quads);
    const ShownPlaces shown = shownPlaces(now->irregular, now->quads, quads);
    resolveEdit(
      *edit, name, { where.places, now->fixed, where.sameWithin, &shown, &quads }, now->irregular);
    edit->upon = data_->linksInForce();
    edit->onFeatures = now->onFeatures;
    edit->withoutMap = now->fixed.insideOfFaces;
    edit->joined = now->joined;
    edit->shown = irregularPoints(now->quads);
  }
  auto next = std::make_shared<SessionState>(data_->next());
  next->constraints.push_back(std::make_shared<const SessionConstraint>(std::move(constraint)));
  data_->enter(std::move(next));
  ++data_->nextId;
  return id;
}

void Session::edit(int id, ConstraintContent content)
{
  auto next = std::make_shared<SessionState>(data_->next());
  const auto found = next->find(id);
  const SessionConstraint& before = **found;
  if (before.content.index() != content.index())
  {
    refuse(before.name(), " cannot become a ", kindOf(content), ": remove it, and add another one");
  }
  SessionConstraint constraint{ id, before.revision + 1, std::move(content) };
  checkConstraint(constraint.content, before.name(), data_->surface.polygonOffsets.size() - 1);
  if (auto* edit = std::get_if<IrregularEdit>(&constraint.content))
  {
    const auto& made = std::get<IrregularEdit>(before.content);
    const std::shared_ptr<const SessionResult> now = result();
    const PlacesOfSession where = data_->places(settings());
    const FixedPlaces none;
    const QuadMesh noQuads;
    const NearestQuads quads(now ? now->quads : noQuads);
    const ShownPlaces shown = shownPlaces(made.before, now ? now->quads : noQuads, quads);
    resolveEdit(*edit, before.name(),
      { where.places, now ? now->fixed : none, where.sameWithin, &shown, &quads }, made.before);
    edit->upon = made.upon;
    edit->onFeatures = made.onFeatures;
    edit->withoutMap = made.withoutMap;
    edit->joined = made.joined;
    edit->shown = made.shown;
  }
  *found = std::make_shared<const SessionConstraint>(std::move(constraint));
  data_->enter(std::move(next));
}

void Session::remove(int id)
{
  auto next = std::make_shared<SessionState>(data_->next());
  next->constraints.erase(next->find(id));
  data_->enter(std::move(next));
}

const std::vector<std::shared_ptr<const SessionConstraint>>& Session::constraints() const
{
  return data_->now().constraints;
}

const SessionReport& Session::update()
{
  SessionState& state = data_->now();
  const double start = secondsNow();
  if (const auto found = data_->resultOf(state))
  {
    SessionReport& report = found->report;
    report.stages.clear();
    report.reused = { "all" };
    report.runs = 0;
    report.tries = {};
    report.seconds = secondsNow() - start;
    return report;
  }
  const MadeState run = runState(*data_, state);
  if (const std::shared_ptr<SessionResult>& made = run.result)
  {
    const bool isStopped = !made->report.stopped.empty();
    data_->soFar = { isStopped ? made : nullptr, state.key() };
    if (!isStopped)
    {
      data_->keep(state, made);
    }
    return made->report;
  }
  data_->stopped = {};
  data_->stopped.status = run.stopped;
  return data_->stopped;
}

std::shared_ptr<const SessionResult> Session::result() const
{
  const SessionState& now = data_->now();
  const auto found = data_->resultOf(now);
  return !found && data_->soFar.state == now.key() ? data_->soFar.result : found;
}

SessionResult Session::preview()
{
  for (const auto& constraint : constraints())
  {
    if (std::holds_alternative<MirrorSymmetry>(constraint->content) ||
      std::holds_alternative<RotationalSymmetry>(constraint->content))
    {
      refuse("there is no preview of symmetric quads: make the result, or remove ",
        constraint->name(), " first");
    }
  }
  const MadeState run = runState(*data_, data_->now(), true);
  if (const std::shared_ptr<SessionResult>& made = run.result)
  {
    return std::move(*made);
  }
  SessionResult stopped;
  stopped.report.status = run.stopped;
  return stopped;
}

bool Session::undo()
{
  if (!canUndo())
  {
    return false;
  }
  --data_->at;
  return true;
}

bool Session::redo()
{
  if (!canRedo())
  {
    return false;
  }
  ++data_->at;
  return true;
}

bool Session::canUndo() const
{
  return data_->at > 0;
}

bool Session::canRedo() const
{
  return data_->at + 1 < data_->history.size();
}

void Session::nameState(const std::string& name)
{
  if (name.empty())
  {
    refuse("a state needs a name that is not empty");
  }
  data_->names[name] = data_->history[data_->at];
}

void Session::goTo(const std::string& name)
{
  data_->enter(std::make_shared<SessionState>(data_->named(name)));
}

std::vector<std::string> Session::stateNames() const
{
  std::vector<std::string> names;
  for (const auto& [name, state] : data_->names)
  {
    names.push_back(name);
  }
  return names;
}

StateComparison Session::compare(const std::string& first, const std::string& second) const
{
  const SessionState& a = data_->named(first);
  const SessionState& b = data_->named(second);
  StateComparison comparison;
  comparison.settings = settingDifferences(a.settings, b.settings);
  std::map<int, const SessionConstraint*> inFirst;
  for (const auto& constraint : a.constraints)
  {
    inFirst[constraint->id] = constraint.get();
  }
  for (const auto& constraint : b.constraints)
  {
    const auto found = inFirst.find(constraint->id);
    if (found == inFirst.end())
    {
      comparison.onlySecond.push_back(constraint->id);
      continue;
    }
    if (constraintToJson(*found->second) != constraintToJson(*constraint))
    {
      comparison.changed.push_back(constraint->id);
    }
    inFirst.erase(found);
  }
  for (const auto& [id, constraint] : inFirst)
  {
    comparison.onlyFirst.push_back(id);
  }
  const auto resultA = data_->resultOf(a);
  const auto resultB = data_->resultOf(b);
  if (resultA && resultB)
  {
    StateComparison::Results results;
    results.quads[0] = resultA->quads.quads.size();
    results.quads[1] = resultB->quads.quads.size();
    results.irregular[0] = resultA->irregular.size();
    results.irregular[1] = resultB->irregular.size();
    measureDistance(*resultA, *resultB, results);
    comparison.results = results;
  }
  return comparison;
}

} // namespace quadrille
