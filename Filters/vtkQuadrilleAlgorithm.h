// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkQuadrilleAlgorithm
 * @brief   what the filters of Quadrille share: threads, time limit, errors, progress, MPI
 *
 * A filter of Quadrille works on a whole surface. Under MPI rank 0 asks for the whole of its input and the
 * other ranks have an empty output. Any failure is reported through vtkErrorMacro with the
 * element that is at fault, and GetOutcome() says what kind of failure it was. The outputs then hold the previous result,
 * unchanged, as they do after a stop on request; they are empty where there was none.
 */
#ifndef vtkQuadrilleAlgorithm_h
#define vtkQuadrilleAlgorithm_h

#include "QuadrilleFiltersModule.h" // for the export macro
#include "vtkPolyDataAlgorithm.h"
#include "vtkSmartPointer.h" // for vtkSmartPointer

#include <chrono>     // for std::chrono::steady_clock
#include <functional> // for std::function
#include <string>     // for std::string
#include <utility>    // for std::pair
#include <vector>     // for std::vector

namespace quadrille
{
struct Certificate;
struct StageRecord;
}

class QUADRILLEFILTERS_EXPORT vtkQuadrilleAlgorithm : public vtkPolyDataAlgorithm
{
public:
  vtkTypeMacro(vtkQuadrilleAlgorithm, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// How the last execution ended.
  enum OutcomeType
  {
    NotRun = 0,
    Succeeded,
    BadInput,      ///< the input or a property is at fault; the text names the element
    NoValidResult, ///< the stages ended without a valid result
    Aborted,       ///< the user asked to stop
    TimedOut,      ///< TimeLimit was reached
    TooLarge       ///< the result would exceed MaximumNumberOfQuads
  };

  ///@{
  /**
   * Number of threads, 0 or more; 0, the default, means all. The result does not depend on it.
   */
  vtkSetClampMacro(NumberOfThreads, int, 0, VTK_INT_MAX);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

  ///@{
  /**
   * The filter gives up, with an error, after this many seconds; 0, the default, means no limit.
   * It is looked at whenever a stage reports progress.
   */
  vtkSetClampMacro(TimeLimit, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(TimeLimit, double);
  ///@}

  /// An OutcomeType.
  vtkGetMacro(Outcome, int);
  /// The reason of a failure, and what the outputs hold; empty after success.
  const char* GetOutcomeText() { return this->OutcomeText.c_str(); }
  /// Seconds and sizes of the stages of the last execution, one stage a line.
  const char* GetStageTimesText() { return this->StageTimesText.c_str(); }
  /// Whether the map of the last execution is an integer-grid map, and why not.
  const char* GetCertificateText() { return this->CertificateText.c_str(); }
  /// What the user should know: repairs, raised budgets, arrays that were not used.
  const char* GetNoticesText() { return this->NoticesText.c_str(); }

protected:
  vtkQuadrilleAlgorithm();
  ~vtkQuadrilleAlgorithm() override;

  int RequestUpdateExtent(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestData(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

  /// Whether an execution with the same properties and arrays as the last one, which succeeded, returns its result instead of making it
  /// again; ResultIsKept() hears of it. Default: no.
  virtual bool KeepsResult() { return false; }
  virtual void ResultIsKept() {}

  /// The filter's own work; throws on any failure, RequestData turns that into an error.
  virtual void Execute(vtkInformationVector** inputs, vtkInformationVector* outputs) = 0;

  /// A callback for Core that maps a stage's own fraction to [begin, end] of the filter's progress
  /// and stops the stage on abort or when the time is over.
  std::function<bool(double, const std::string&)> MakeProgress(double begin, double end);

  void SetStageRecords(const std::vector<quadrille::StageRecord>& stages);
  void SetCertificate(const quadrille::Certificate& certificate);
  void AddNotice(const std::string& text);

  int NumberOfThreads = 0;
  double TimeLimit = 0;

private:
  vtkQuadrilleAlgorithm(const vtkQuadrilleAlgorithm&) = delete;
  void operator=(const vtkQuadrilleAlgorithm&) = delete;

  void ResetOutcome();
  bool ShowProgressAndGoOn();
  void KeepResult(vtkInformationVector* outputs);
  void RestoreResult(vtkInformationVector* outputs);
  /// What the outputs hold after a failure.
  std::string DescribeOutputs() const;
  int Fail(OutcomeType outcome, const std::string& text, vtkInformationVector* outputs);
  int FailCancelled(vtkInformationVector* outputs);

  int Outcome = NotRun;
  bool TimeIsOver = false;
  double FarthestProgress = 0;
  std::vector<vtkSmartPointer<vtkDataObject>> LastResult; ///< shares its arrays with the outputs
  /// Times of the filter and its inputs at the last success; empty where there was none.
  std::vector<std::pair<const void*, vtkMTimeType>> LastStamps;
  std::chrono::steady_clock::time_point Started;
  std::string OutcomeText;
  std::string StageTimesText;
  std::string CertificateText;
  std::string NoticesText;
};

#endif
