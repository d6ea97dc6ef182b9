// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkQuadrilleSession
 * @brief   a surface, what is asked of it, and every state that it has been through
 *
 * Constraints have ids that never change. Every change makes a state to which Undo() goes back; what was made of a
 * state is remembered, so that going back makes nothing, and Update() makes what the present state needs. The
 * constraints are texts in JSON: `{"kind": "guide", "points": [[x, y, z], ...], "weight": 1, "radius": 0}`, in the
 * same way "feature" (points), "guide region" (polygons, direction, weight), "valence" (point, valence), "size"
 * (point, radius, factor), "size region" (polygons, factor), "irregular" (operation: "move", "split", "merge",
 * "cancel" or "add"; points, valences), "connection" (points), "cycle" (points), "symmetry" (origin and normal of the
 * plane, or neither: it is found), "rotation" (order; origin and direction of the axis, or neither).
 * Python's quadrille.Session has a method for each.
 *
 * A method that fails returns false, 0 or an empty text; GetErrorText() says why. While Update() runs, the session
 * invokes ProgressEvent; GetProgress() is the fraction, and AbortUpdateOn() in an observer stops the run.
 */
#ifndef vtkQuadrilleSession_h
#define vtkQuadrilleSession_h

#include "QuadrilleFiltersModule.h"
#include "vtkObject.h"
#include "vtkSmartPointer.h"

#include <memory>
#include <string>

class vtkPolyData;

namespace quadrille
{
class Session;
}

class QUADRILLEFILTERS_EXPORT vtkQuadrilleSession : public vtkObject
{
public:
  static vtkQuadrilleSession* New();
  vtkTypeMacro(vtkQuadrilleSession, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * Begins with a surface and the arrays that it has (see vtkQuadrilleSurfaceAlgorithm), and with settings as JSON:
   * one of "quads", "edge_length" and "relative_edge_length", and "feature_angle" (radians; null: none),
   * "feature_criterion" ("creases" or "angle"), "chord_error" (null: off), "angle_a_quad" (radians; null: off),
   * "gap_quads", "smallest_size", "largest_size", "curvature_guides" (null: off), "method", "integers",
   * "coarse_vertices", "smallest_detail", "small_details", "small_components", "anisotropy_limit", "final_quality",
   * "distortion_metric", "maximum_number_of_quads", "smoothing_steps", "warm_start", "threads", "memory_limit" (bytes).
   * What went before is let go.
   */
  bool Start(vtkPolyData* surface, const std::string& settings);

  ///@{
  /**
   * A file with constraints, settings and named states. It refers to the surface by its contents: another one is
   * refused.
   */
  bool Save(const std::string& fileName);
  bool Load(const std::string& fileName, vtkPolyData* surface);
  ///@}

  ///@{
  /**
   * Settings as JSON; those that are not named stay.
   */
  bool SetSettings(const std::string& settings);
  std::string GetSettings();
  ///@}

  /// Returns the id, above 0.
  int AddConstraint(const std::string& constraint);
  /// By one of the same kind.
  bool EditConstraint(int id, const std::string& constraint);
  bool RemoveConstraint(int id);
  /// A list, with "id" and "revision".
  std::string GetConstraints();

  /// False where there are no quads afterwards.
  bool Update();
  /**
   * Of the last Update(): "ok", "status", "message", "stages" (that ran, with seconds), "reused", "runs" (0: nothing
   * was to do), "seconds", "notices", "constraints" (id, kind, text, place, met, deviation, deviation_95, unit,
   * reason, remark).
   */
  std::string GetReport() const;

  ///@{
  /**
   * Of the present state: the quads, with Valence and OnBoundary on points, and with a symmetry MirrorPoint; the
   * irregular vertices inside, off features, with Valence. Empty before Update().
   */
  vtkPolyData* GetQuads();
  vtkPolyData* GetIrregularVertices();
  ///@}

  ///@{
  /**
   * Quads of the present state in a time that follows their number: those of the intermediate level, from which
   * Update() goes on. They are not the state's quads, and the report stays. Refused where a symmetry is asked for.
   * GetPreviewQuads() has those of the last call that returned true.
   */
  bool Preview();
  vtkPolyData* GetPreviewQuads();
  ///@}

  ///@{
  /**
   * To the state before, or after. False where there is none.
   */
  bool Undo();
  bool Redo();
  bool CanUndo();
  bool CanRedo();
  ///@}

  ///@{
  /**
   * States with names. Compare() takes an empty name for the present state, and returns what differs: "settings",
   * "only_first", "only_second", "changed" (ids), and where both have results "quads", "irregular", "distance" and
   * "unmatched".
   */
  bool NameState(const std::string& name);
  bool GoTo(const std::string& name);
  int GetNumberOfNamedStates();
  std::string GetStateName(int i);
  std::string Compare(const std::string& first, const std::string& second);
  ///@}

  ///@{
  /**
   * Stops a run that is on. It is off again when the next one starts. Default: off.
   */
  vtkSetMacro(AbortUpdate, bool);
  vtkGetMacro(AbortUpdate, bool);
  vtkBooleanMacro(AbortUpdate, bool);
  ///@}

  /// Of the run that is on, from 0 to 1.
  vtkGetMacro(Progress, double);

  /// Why the last call failed, and whether what was given is at fault; empty where it did not.
  std::string GetErrorText() const;
  bool GetErrorIsInInput() const;

protected:
  vtkQuadrilleSession();
  ~vtkQuadrilleSession() override;

private:
  vtkQuadrilleSession(const vtkQuadrilleSession&) = delete;
  void operator=(const vtkQuadrilleSession&) = delete;

  struct Internals;
  /// Progress of its runs becomes events.
  void TellProgress(quadrille::Session& session);

  std::unique_ptr<Internals> Data;
  bool AbortUpdate = false;
  double Progress = 0;
};

#endif
