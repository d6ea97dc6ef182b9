// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Ranks/SpreadFigures.h"

#include "Common/NewArray.h"

#include <vtkDataObject.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>

#include <algorithm>
#include <cstdio>
#include <fstream>

namespace quadrille
{

namespace
{

std::vector<std::pair<std::string, double>> namedFigures(const SpreadFigures& figures)
{
  std::vector<std::pair<std::string, double>> named = { { "faces",
                                                          static_cast<double>(figures.faces) },
    { "level_faces", static_cast<double>(figures.levelFaces) },
    { "border_points", static_cast<double>(figures.borderPoints) },
    { "shared_points", static_cast<double>(figures.sharedPoints) },
    { "quads", static_cast<double>(figures.quads) },
    { "gathered_bytes", static_cast<double>(figures.gathered) },
    { "redistributed_bytes", static_cast<double>(figures.redistributed) },
    { "sent_bytes", static_cast<double>(figures.traffic.sent) },
    { "received_bytes", static_cast<double>(figures.traffic.received) },
    { "peak_bytes", figures.peakMemory } };
  for (const auto& [stage, seconds] : figures.seconds)
  {
    named.emplace_back(stage + "_seconds", seconds);
  }
  return named;
}

} // namespace

void SpreadFigures::pack(Packer& packer) const
{
  for (const std::size_t value :
    { faces, levelFaces, borderPoints, sharedPoints, quads, gathered, redistributed })
  {
    packer.count(value);
  }
  packer.count(traffic.sent);
  packer.count(traffic.received);
  packer.number(peakMemory);
  packer.count(seconds.size());
  for (const auto& [stage, spent] : seconds)
  {
    packer.text(stage);
    packer.number(spent);
  }
}

SpreadFigures SpreadFigures::unpack(Unpacker& unpacker)
{
  SpreadFigures figures;
  for (std::size_t* value : { &figures.faces, &figures.levelFaces, &figures.borderPoints,
         &figures.sharedPoints, &figures.quads, &figures.gathered, &figures.redistributed })
  {
    *value = unpacker.count();
  }
  figures.traffic.sent = unpacker.count();
  figures.traffic.received = unpacker.count();
  figures.peakMemory = unpacker.number();
  const std::uint64_t stages = unpacker.count();
  for (std::uint64_t i = 0; i < stages; ++i)
  {
    std::string stage = unpacker.text();
    figures.seconds.emplace_back(std::move(stage), unpacker.number());
  }
  return figures;
}

SpreadTimer::SpreadTimer(SpreadFigures& figures, const char* stage)
  : figures_(figures), stage_(stage), begin_(std::chrono::steady_clock::now())
{
}

SpreadTimer::~SpreadTimer()
{
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin_;
  const auto known = std::find_if(figures_.seconds.begin(), figures_.seconds.end(),
    [this](const auto& stage) { return stage.first == stage_; });
  if (known != figures_.seconds.end())
  {
    known->second += spent.count();
    return;
  }
  figures_.seconds.emplace_back(std::move(stage_), spent.count());
}

double peakMemory()
{
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
  {
    double kilobytes = 0;
    if (std::sscanf(line.c_str(), "VmHWM: %lf kB", &kilobytes) == 1)
    {
      return 1024 * kilobytes;
    }
  }
  return 0;
}

void addSpreadFigures(vtkDataObject* data, const std::vector<SpreadFigures>& figures)
{
  const auto columns = namedFigures(figures.front());
  auto array =
    newArray<vtkDoubleArray>("SpreadFigures", static_cast<int>(columns.size()), figures.size());
  for (std::size_t c = 0; c < columns.size(); ++c)
  {
    array->SetComponentName(static_cast<vtkIdType>(c), columns[c].first.c_str());
  }
  for (std::size_t r = 0; r < figures.size(); ++r)
  {
    const auto named = namedFigures(figures[r]);
    for (std::size_t c = 0; c < columns.size(); ++c)
    {
      array->SetComponent(
        static_cast<vtkIdType>(r), static_cast<int>(c), c < named.size() ? named[c].second : 0);
    }
  }
  data->GetFieldData()->AddArray(array);
}

std::string spreadText(const std::vector<SpreadFigures>& figures)
{
  std::string text;
  char line[200];
  for (std::size_t i = 0; i < figures.front().seconds.size(); ++i)
  {
    double slowest = 0;
    for (const SpreadFigures& one : figures)
    {
      slowest = std::max(slowest, i < one.seconds.size() ? one.seconds[i].second : 0);
    }
    std::snprintf(
      line, sizeof(line), "spread %s: %.3f s\n", figures.front().seconds[i].first.c_str(), slowest);
    text += line;
  }
  double gathered = 0, sent = 0, memory = 0;
  for (const SpreadFigures& one : figures)
  {
    gathered += static_cast<double>(one.gathered);
    sent = std::max(sent, static_cast<double>(one.traffic.sent));
    memory = std::max(memory, one.peakMemory);
  }
  std::snprintf(line, sizeof(line),
    "spread over %zu ranks: %.1f MB gathered, at most %.1f MB sent by a rank and %.0f MB held",
    figures.size(), 1e-6 * gathered, 1e-6 * sent, 1e-6 * memory);
  return text + line;
}

} // namespace quadrille
