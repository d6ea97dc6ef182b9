// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// One run of vtkQuadRemesh for a program: errors are collected instead of printed.
#pragma once

#include <vtkNew.h>
#include <vtkQuadRemesh.h>
#include <vtkSmartPointer.h>

#include <chrono>
#include <functional>
#include <string>
#include <vector>

class vtkCallbackCommand;
class vtkPolyData;

namespace quadrille
{

/// Exit codes of the programs.
enum ExitCode
{
  kValidQuads = 0,
  kBadInput = 2,
  kNoValidResult = 3,
  kStoppedQuads = 4, ///< stopped, with the best valid quads so far
  kPartialQuads = 5  ///< valid quads of some connected components: others have no map
};

/// Whether there are quads to be written.
inline bool hasQuads(ExitCode code)
{
  return code == kValidQuads || code == kStoppedQuads || code == kPartialQuads;
}

struct StageRow
{
  std::string stage;
  double seconds = 0;
  long long elementsIn = 0;
  long long elementsOut = 0;
};

class RemeshRun
{
public:
  RemeshRun();
  ~RemeshRun();

  vtkQuadRemesh* filter() { return filter_; }
  /// Called with the fraction done and what is being done; false asks to stop.
  void onProgress(std::function<bool(double, const std::string&)> progress);

  /// Calls it as the filter would, for filters beside it; false asks to stop.
  bool tellProgress(double fraction, const std::string& text);

  ExitCode execute(vtkPolyData* input);
  /// What else there is to know than the filter's own notices, and why there is no result though the filter has one.
  void addNotice(const std::string& text);
  void fail(const std::string& reason) { failure_ = reason; }
  /// Those of the filter and the others, one a line.
  std::string notices();
  /// The reason when execute() did not return kValidQuads.
  std::string error() const;
  /// The longest time of the last execution in which it could not have been stopped, in seconds, and the progress text
  /// before it.
  double longestGap() const { return longestGap_; }
  const std::string& longestGapText() const { return longestGapText_; }
  /// Rows of the field data; empty after a failure.
  std::vector<StageRow> stages();

private:
  void closeGap();

  vtkNew<vtkQuadRemesh> filter_;
  vtkNew<vtkCallbackCommand> onError_;
  vtkNew<vtkCallbackCommand> onProgress_;
  std::function<bool(double, const std::string&)> progress_;
  std::string errors_;
  std::string notices_;
  std::string failure_;
  std::chrono::steady_clock::time_point lastCall_;
  double longestGap_ = 0;
  std::string longestGapText_;
  std::string lastText_;
};

} // namespace quadrille
