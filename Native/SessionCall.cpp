// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Native/SessionCall.h"

#include "Base/Refuse.h"
#include "Native/Arrays.h"
#include "Native/Errors.h"
#include "Native/ProgressCall.h"
#include "Native/Results.h"
#include "Session/SessionText.h"

#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace quadrille::native
{

namespace
{

class SessionCall
{
public:
  /// progress: None, or called as progress(fraction).
  explicit SessionCall(py::object progress) : progress_(std::move(progress)) {}

  bool start(const py::dict& surface, const std::string& settings)
  {
    RemeshOptions options;
    settingsFromText(settings, options);
    session_.emplace(surfaceFrom(surface), options);
    report_.clear();
    return true;
  }
  bool load(const std::string& file, const py::dict& surface)
  {
    session_.emplace(Session::load(file, surfaceFrom(surface)));
    report_.clear();
    return true;
  }
  Session& get()
  {
    if (!session_)
    {
      refuse("the session has no surface: start it, or load one");
    }
    return *session_;
  }

  /// Operations on irregular vertices make the quads before them.
  int add(const std::string& constraint)
  {
    return run([&](Session& session) { return session.add(contentFromText(constraint)); });
  }
  bool edit(int id, const std::string& constraint)
  {
    return run(
      [&](Session& session)
      {
        session.edit(id, contentFromText(constraint));
        return true;
      });
  }
  bool update()
  {
    const Status status = run(
      [this](Session& session)
      {
        const SessionReport& report = session.update();
        report_ = reportText(report);
        return report.status;
      });
    requireOk(status);
    return true;
  }
  bool preview()
  {
    preview_ = run([](Session& session) { return session.preview(); });
    requireOk(preview_.report.status);
    return true;
  }
  const std::string& report() const { return report_; }

  py::tuple previewQuads() const { return quadArrays(preview_.quads); }
  /// Points, quads, and point data by names.
  py::tuple quads()
  {
    const SessionResult& made = *result();
    py::dict pointData;
    pointData["Valence"] = arrayFrom(made.quads.valence);
    pointData["OnBoundary"] = arrayFrom(made.quads.onBoundary);
    if (!made.mirrorPoint.empty())
    {
      pointData["MirrorPoint"] = castArrayFrom<std::int64_t>(made.mirrorPoint);
    }
    if (!made.rotatedPoint.empty())
    {
      pointData["RotatedPoint"] = castArrayFrom<std::int64_t>(made.rotatedPoint);
    }
    return quadArrays(made.quads) + py::make_tuple(pointData);
  }
  /// Places and valences.
  py::tuple irregular()
  {
    std::vector<Vector3> places;
    std::vector<int> valences;
    for (const IrregularVertex& vertex : result()->irregular)
    {
      places.push_back(vertex.place);
      valences.push_back(vertex.valence);
    }
    return py::make_tuple(arrayFrom(places), arrayFrom(valences));
  }

private:
  std::shared_ptr<const SessionResult> result()
  {
    std::shared_ptr<const SessionResult> made = get().result();
    if (!made)
    {
      refuse("the present state has no quads: call update()");
    }
    return made;
  }

  static void requireOk(const Status& status)
  {
    if (!status.ok())
    {
      throw RunFailure(status.message);
    }
  }

  template <class Act>
  auto run(const Act& act) -> decltype(act(std::declval<Session&>()))
  {
    Session& session = get();
    ProgressCall call(progress_, false, 0);
    session.setProgress(call.callback(0, 1));
    const auto done = [&]
    {
      session.setProgress({});
      call.rethrow();
    };
    try
    {
      auto made = withoutLock([&] { return act(session); });
      done();
      return made;
    }
    catch (const std::exception&)
    {
      done(); // what the function raised goes before the stop that it led to
      throw;
    }
  }

  py::object progress_;
  std::optional<Session> session_;
  std::string report_;
  SessionResult preview_;
};

} // namespace

void bindSession(py::module_& module)
{
  const auto done = [](SessionCall& session, auto&& act)
  {
    act(session.get());
    return true;
  };
  py::class_<SessionCall>(module, "Session")
    .def(py::init<py::object>())
    .def("Start", &SessionCall::start)
    .def("Load", &SessionCall::load)
    .def("Save",
      [done](SessionCall& s, const std::string& file)
      { return done(s, [&](Session& session) { session.save(file); }); })
    .def("SetSettings",
      [done](SessionCall& s, const std::string& text)
      { return done(s, [&](Session& session) { changeSettings(session, text); }); })
    .def("GetSettings", [](SessionCall& s) { return settingsText(s.get().settings()); })
    .def("AddConstraint", &SessionCall::add)
    .def("EditConstraint", &SessionCall::edit)
    .def("RemoveConstraint",
      [done](SessionCall& s, int id)
      { return done(s, [&](Session& session) { session.remove(id); }); })
    .def("GetConstraints", [](SessionCall& s) { return constraintsText(s.get()); })
    .def("Update", &SessionCall::update)
    .def("Preview", &SessionCall::preview)
    .def("GetReport", &SessionCall::report)
    .def("GetPreviewQuads", &SessionCall::previewQuads)
    .def("GetQuads", &SessionCall::quads)
    .def("GetIrregularVertices", &SessionCall::irregular)
    .def("Undo", [](SessionCall& s) { return s.get().undo(); })
    .def("Redo", [](SessionCall& s) { return s.get().redo(); })
    .def("NameState",
      [done](SessionCall& s, const std::string& name)
      { return done(s, [&](Session& session) { session.nameState(name); }); })
    .def("GoTo",
      [done](SessionCall& s, const std::string& name)
      { return done(s, [&](Session& session) { session.goTo(name); }); })
    .def("GetStateNames", [](SessionCall& s) { return s.get().stateNames(); })
    .def("Compare",
      [](SessionCall& s, const std::string& first, const std::string& second)
      { return comparisonText(s.get().compare(first, second)); });
}

} // namespace quadrille::native
