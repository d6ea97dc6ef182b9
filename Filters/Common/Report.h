// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/// What a run has to say for itself: failures, stage times, certificate, repair, as text and field data.
#pragma once

#include "Base/Error.h"
#include "GridMap/GridMap.h"
#include "Mesh/Surface.h"
#include "Pipeline/RunFields.h"

#include <stdexcept>
#include <string>
#include <vector>

class vtkDataObject;

namespace quadrille
{

/// A stage's Status that is not ok, on its way to the filter's error.
class StageFailure : public std::runtime_error
{
public:
  StageFailure(StatusCode c, const std::string& text) : std::runtime_error(text), code(c) {}
  StatusCode code;
};

/// There was too little memory: the next execution may pass.
class OutOfMemory : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/// Throws StageFailure unless the status is ok; `stage` says who failed when the message does not.
void requireOk(const Status& status, const std::string& stage);

/// "phase1: 0.52 s, 69451 -> 20312", one stage a line, and the sum.
std::string stageTimesText(const std::vector<StageRecord>& stages);

/// Breaks lines between words where they are longer than `width` letters; what follows a break is indented by two.
/// ParaView's fields do not wrap.
std::string wrapLines(const std::string& text, std::size_t width);

/// The lines of a text without empty ones.
std::vector<std::string> splitLines(const std::string& text);

/// Field arrays. Existing ones of the same name are replaced.
void addText(vtkDataObject* data, const char* name, const std::vector<std::string>& lines);
void addNumber(vtkDataObject* data, const char* name, double value);
void addCount(vtkDataObject* data, const char* name, std::size_t value);

void addFields(vtkDataObject* data, const RunFields& fields);

/// What methodFields told; the default where there is nothing.
MapMethod readMethod(vtkDataObject* data);

} // namespace quadrille
