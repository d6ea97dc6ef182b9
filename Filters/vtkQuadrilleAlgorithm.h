// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkQuadrilleAlgorithm
 * @brief   what the filters of Quadrille share: blocks, threads, time limit, errors, progress, MPI
 *
 * A filter of Quadrille works on whole surfaces. A data set is one; composite data has one for each of its blocks, and
 * the outputs are composite data with the same structure and names. Of a data set that is no vtkPolyData the surface is
 * taken.
 *
 * Any failure is reported through vtkErrorMacro with the element that is at fault, and GetOutcome() says what kind of
 * failure it was. The outputs then hold the previous result, unchanged; they are empty where there was none. After a
 * stop, on request or by TimeLimit, they hold the best result so far where the filter has one by then (GetIsSoFar()),
 * else the previous one. A block that fails keeps its own previous result, and the others get theirs; the error
 * names the blocks. Texts of several blocks begin each line with the name of the block.
 *
 * In a parallel run each rank has its part of the input. The pieces of a surface are brought to one rank and put
 * together there, in an order that does not depend on how they were cut, so that the result is the same for any number
 * of ranks; see RankIndependent. The blocks of composite data are spread over the ranks. The outputs lie on the rank
 * that made them and are empty on the others; what the filter tells is the same on all. Ranks work together where as
 * many pieces are asked for as there are ranks, as ParaView does.
 */
#ifndef vtkQuadrilleAlgorithm_h
#define vtkQuadrilleAlgorithm_h

#include "QuadrilleFiltersModule.h" // for the export macro
#include "vtkPolyDataAlgorithm.h"
#include "vtkSmartPointer.h" // for vtkSmartPointer

#include <chrono>     // for std::chrono::steady_clock
#include <exception>  // for std::exception_ptr
#include <functional> // for std::function
#include <map>        // for std::map
#include <memory>     // for std::unique_ptr
#include <string>     // for std::string
#include <utility>    // for std::pair
#include <vector>     // for std::vector

class vtkFieldData;

namespace quadrille
{
struct Block;
struct BlockReport;
struct BlockRun;
struct BlockState;
struct BlockWork;
struct Certificate;
struct EarlierResult;
class SharedStop;
struct SpreadPlan;
struct SpreadSize;
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
    TooLarge,      ///< the result would exceed MaximumNumberOfQuads
    Underway       ///< it is being made in the background
  };

  /// See SetRankIndependent().
  enum RankIndependentType
  {
    Never = 0,
    Always,
    UnderMPI
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
   * The filter gives up after this many seconds; 0, the default, means no limit. It is looked at whenever a stage
   * reports progress. Where there is a result by then that was still to be made better, the outputs hold it, with a
   * warning; else it is an error.
   */
  vtkSetClampMacro(TimeLimit, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(TimeLimit, double);
  ///@}

  ///@{
  /**
   * Whether a surface that comes in one piece is put into the order of one that comes in several, too, a
   * RankIndependentType. Then the result is the same for any number of ranks, also for one; ids as in `SourceCellId`
   * count in that order. Otherwise one piece stays as it is. Default: UnderMPI, that is where mpiexec or srun has
   * started the session, with any number of ranks.
   */
  vtkSetClampMacro(RankIndependent, int, Never, UnderMPI);
  vtkGetMacro(RankIndependent, int);
  ///@}

  /**
   * All properties that the result depends on, with their values. Threads and limits are none of them. An execution
   * with the settings and inputs of an earlier one gets its result, where the filter keeps results.
   */
  std::string GetSettings() const;

  /// An OutcomeType.
  vtkGetMacro(Outcome, int);
  /// Whether the last execution was stopped, on request or by TimeLimit, and the outputs hold the best that there was
  /// by then. The next execution makes the result anew.
  bool GetIsSoFar() const { return this->IsSoFar; }
  /// The reason of a failure, and what the outputs hold; empty after success.
  const char* GetOutcomeText() { return this->OutcomeText.c_str(); }
  /// Seconds and sizes of the stages of the last execution, one stage a line.
  const char* GetStageTimesText() { return this->StageTimesText.c_str(); }
  /// Whether the map of the last execution is an integer-grid map, and why not.
  const char* GetCertificateText() { return this->CertificateText.c_str(); }
  /// What the user should know: repairs, raised budgets, arrays that were not used.
  const char* GetNoticesText() { return this->NoticesText.c_str(); }
  /// What the last execution made, or why it failed, and the notices: for the panel.
  const char* GetResultText() { return this->ResultText.c_str(); }
  /// Its first line, unbroken: what was made and whether all is well with it, or why there is nothing. Of several
  /// blocks the first one with something to tell counts.
  const char* GetVerdict() { return this->Verdict.c_str(); }

  vtkTypeBool ProcessRequest(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

protected:
  vtkQuadrilleAlgorithm();
  ~vtkQuadrilleAlgorithm() override;

  vtkExecutive* CreateDefaultExecutive() override;

  /// What a port takes, and how composite data on it is understood.
  enum class PortRole
  {
    Surface,      ///< surfaces of any data sets; a block each, as port 0
    Mesh,         ///< vtkPolyData made by a filter of Quadrille, taken as it is; a block each
    OptionalMesh, ///< the same, or nothing
    Log,          ///< vtkTable; a block each
    Shared ///< vtkPolyData that says something of all surfaces, optional: blocks are put together
  };
  /// Default: Surface for port 0, Shared for all others.
  virtual PortRole GetPortRole(int port) const;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  /// Class name of what a port gives for one block. Default: vtkPolyData.
  virtual const char* GetBlockType(int /*outputPort*/) const { return "vtkPolyData"; }

  virtual int RequestDataObject(vtkInformationVector** inputs, vtkInformationVector* outputs);
  int RequestUpdateExtent(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestData(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

  /// Whether a block with the same properties and arrays as at its last execution, which succeeded, gets that result
  /// instead of a new one; its reused stages are then "all". Default: no.
  virtual bool KeepsResult() { return false; }
  /// Writes the properties that the result depends on, see GetSettings().
  virtual void AddSettings(std::ostream& os) const;
  /// Whether an earlier result with the same settings keeps to the limits that are no settings.
  virtual bool AllowsEarlier(const quadrille::BlockReport& /*report*/) const { return true; }

  /// Whether the target size is one for all blocks together, so that a block has to know its part (Block::areaShare,
  /// Block::wholeDiagonal). Default: no.
  virtual bool HasCommonTarget() const { return false; }
  /// The target that blocks share, where it is a number to be divided; else 0. Default: 0.
  virtual double GetSharedTarget() const { return 0; }
  /// The least part of a target that a block gets, however small it is, with this number of blocks. Default: 0.
  virtual double LeastAreaShare(std::size_t /*blocks*/, double /*target*/) const { return 0; }
  /// The target that a block of composite data has of its own, which it does not share with others; 0 where it has
  /// none. fieldData: of one of its pieces. Throws InvalidInput. Default: 0.
  virtual double ReadOwnTarget(const std::string& block, vtkFieldData* fieldData) const;
  /// Throws InvalidInput where properties name blocks that are not there. Default: nothing.
  virtual void CheckBlockNames(const std::vector<std::string>& names) const;

  ///@{
  /**
   * Whether the surface of a block stays spread over the ranks, a quadrille::SpreadMode; default: Never. The filter
   * then gets the thinned pieces joined, and its output 0, quads with SourceCellId, is spread over the ranks again. Why
   * these pieces of a rank cannot stay spread; empty where they can. What the pieces are thinned out by.
   */
  virtual int GetSpreadMode() const;
  virtual std::string ReasonNotToSpread(
    const std::vector<vtkSmartPointer<vtkPolyData>>& pieces) const;
  virtual void PlanSpread(const quadrille::Block& block, const quadrille::SpreadSize& size,
    quadrille::SpreadPlan& plan) const;
  ///@}

  /// The filter's own work on one block: fills its outputs. Throws on any failure, which becomes the block's error.
  virtual void Execute(quadrille::Block& block) = 0;

  /// The output that shows what is wrong with a block, also where it failed; -1: none. Default: none.
  virtual int GetProblemPort() const { return -1; }
  /// Of a block that failed, for that output; null where there is nothing to show.
  virtual vtkSmartPointer<vtkDataObject> MakeProblems(quadrille::Block& /*block*/)
  {
    return nullptr;
  }

  /// Whether blocks that meet are executed together: those whose boxes touch go to one rank, and FindTogether() is
  /// asked. Default: no.
  virtual bool JoinsBlocks() const { return false; }
  /// Blocks that hang together, by their ids in a list, and what is to be told of it.
  struct Together
  {
    std::vector<std::size_t> blocks; ///< ascending
    std::vector<std::string> notices;
  };
  /// The blocks of a list, each of them once. Default: each for itself.
  virtual std::vector<Together> FindTogether(const std::vector<quadrille::Block*>& blocks);
  /// The same as Execute for two blocks or more that hang together. What is said of the block that is executed is said
  /// of the first one.
  virtual void ExecuteTogether(const std::vector<quadrille::Block*>& blocks);

  /// A callback for Core that maps a stage's own fraction to [begin, end] of the progress of the block that is executed
  /// and stops the stage on abort or when the time is over.
  std::function<bool(double, const std::string&)> MakeProgress(double begin, double end);

  ///@{
  /// Of the block that is executed.
  void SetStageRecords(const std::vector<quadrille::StageRecord>& stages);
  void SetCertificate(const quadrille::Certificate& certificate);
  void AddNotice(const std::string& text);
  /// From now on, of blocks that are executed together, what is said is said of this one.
  void SayOf(quadrille::Block& block);
  /// The stage was stopped and has the best so far, which becomes the block's result: from now on nothing asks to stop
  /// any more until the block is done.
  void KeepSoFar() { this->IsBlockSoFar = true; }
  /// On one rank.
  bool RunsAlone() const { return this->IsAlone; }
  void NoteTimeIsOver() { this->TimeIsOver = true; } ///< of a run in the background
  /// A notice of something that the user asked for and does not get: a warning, too.
  void AddWarning(const std::string& text);
  void SetResult(const std::string& text);
  const std::vector<std::string>& GetBlockNotices() const;
  ///@}

  ///@{
  /// A number of each block's report, over all blocks; 0 where no block has it, and for the least where none has one
  /// above 0.
  double SumOverBlocks(const char* number) const;
  double LeastOverBlocks(const char* number) const;
  ///@}
  /// Stages that blocks had from an earlier execution, one a line.
  const char* GetReusedStages() const { return this->ReusedText.c_str(); }
  /// Calls `visit` with what is kept of each block.
  void VisitStates(const std::function<void(quadrille::BlockState&)>& visit) const;

  int NumberOfThreads = 0;
  double TimeLimit = 0;
  int RankIndependent = UnderMPI;

private:
  vtkQuadrilleAlgorithm(const vtkQuadrilleAlgorithm&) = delete;
  void operator=(const vtkQuadrilleAlgorithm&) = delete;

  using Run = quadrille::BlockRun;
  using Work = quadrille::BlockWork;
  int RunBlocks(Run& run, vtkInformationVector** inputs, vtkInformationVector* outputs);
  void ReadInputs(Run& run, vtkInformationVector** inputs);
  void ListBlocks(Run& run);
  void ReadOwnTargets(Run& run);
  void TakeStates(Run& run);
  void GatherInputs(Run& run);
  bool IsPutInOrder(const Run& run) const;
  void GatherPort(Run& run, Work& work, int port);
  bool StaysSpread(Run& run, Work& work, const std::vector<vtkSmartPointer<vtkDataObject>>& pieces);
  void JoinSpread(Run& run);
  void SpreadResults(Run& run);
  void SpreadResult(Run& run, Work& work);
  void WaitForAll(Run& run);
  void MeasureBlocks(Run& run);
  void ShareTarget(Run& run, const std::vector<double>& areas);
  void GroupBlocks(Run& run);
  void RunWorks(const std::vector<Work*>& works);
  bool TakeEarlier(Work& work, bool andUse);
  quadrille::EarlierResult ResultFor(const Work& work) const;
  void RunTogether(const std::vector<Work*>& works, const std::vector<std::string>& notices);
  void PrepareOutputs(quadrille::Block& block);
  void ExecuteBlock(quadrille::Block& block);
  void ConcludeBlock(Work& work);
  void FailBlock(quadrille::BlockState& state, OutcomeType outcome, const std::string& text);
  void ShowFailure(quadrille::Block& block);
  void FailBlockAsStopped(quadrille::BlockState& state);
  void FailBlockBy(quadrille::BlockState& state, const std::exception_ptr& failure);
  std::string StopText() const;
  void ExchangeReports(Run& run);
  int Conclude(const Run& run, vtkInformationVector* outputs);
  int ReportFailure(const std::string& text);

  void ResetOutcome();
  void SetReports(const std::vector<std::pair<std::string, quadrille::BlockReport>>& reports);
  bool ShowProgressAndGoOn();

  int Outcome = NotRun;
  bool TimeIsOver = false;
  bool IsSoFar = false;
  bool IsBlockSoFar = false; ///< of the block that is executed
  double FarthestProgress = 0;
  double BlockBegin = 0; ///< of the filter's progress
  double BlockEnd = 1;
  std::chrono::steady_clock::time_point Started;
  quadrille::SharedStop* Stop = nullptr; ///< while each rank works on its own blocks
  bool IsAlone = true;
  bool IsRoot = true; ///< of the ranks of the last execution; it alone prints messages
  std::map<std::string, std::unique_ptr<quadrille::BlockState>>
    States;                                    ///< by place and name of the block
  quadrille::BlockReport* Report = nullptr;    ///< of the block that is executed
  std::vector<quadrille::BlockReport> Reports; ///< of all blocks of the last execution
  std::string OutcomeText;
  std::string StageTimesText;
  std::string CertificateText;
  std::string NoticesText;
  std::string ResultText;
  std::string Verdict;
  std::string ReusedText;
};

#endif
