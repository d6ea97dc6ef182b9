// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSMQuadrilleSourceProxy
 * @brief   a filter whose panel tells of the execution just over, and whose outputs come with a display
 *
 * ParaView 5.11 asks a filter for its information properties before it executes it, so that the panel shows what was
 * valid one Apply ago. This proxy asks again after each execution.
 *
 * A representation that could not update, because the filter failed, waits in ParaView 5.11 for ever: its proxy passes
 * a change on only when the one before it was shown. This proxy tells the representations behind it of each change
 * itself.
 *
 * A hint `<Display port="4" property="PointSize" value="12"/>` sets a property of each representation of an output at
 * the moment it is made; there is one element for each property, with one number. What a user, a script or a state file
 * sets later stays.
 *
 * A hint `<Colour port="8" cells="Problem"/>` has the representations of an output coloured by an array of its cells as
 * soon as it has cells, where they have had no colours by then: a solid colour that is chosen later stays, and so does
 * that of a state file.
 *
 * A hint `<OnDemand port="1" property="ComputeMappedSurface"/>` switches the property on when something takes the
 * output as its input: ParaView gathers information of all outputs, looked at or not, so what costs is not made before.
 *
 * Outputs other than the first come with *Pickable* off: balls of irregular vertices, lines and the like do not stand
 * in the way of picks and selections, which go through to the quads. ParaView 5.11 and 5.13 take the id of what they
 * pick for one of the first output, so that a pick of any other gives another place.
 *
 * A hint `<ColourMap array="Valence">` with elements `<Entry value="3" text="3" red="0.2" green="0.4" blue="0.9"/>`
 * gives the values of an array colours and names of their own, in the legend, too; where the array has a colour map
 * already, that stays.
 *
 * In the XML of the server manager it is the element QuadrilleSourceProxy.
 */
#ifndef vtkSMQuadrilleSourceProxy_h
#define vtkSMQuadrilleSourceProxy_h

#include "QuadrilleServerManagerModule.h" // for the export macro
#include "vtkSMSourceProxy.h"
#include "vtkWeakPointer.h" // for properties of representations

#include <vector> // for these

class vtkSMProperty;

class QUADRILLESERVERMANAGER_EXPORT vtkSMQuadrilleSourceProxy : public vtkSMSourceProxy
{
public:
  static vtkSMQuadrilleSourceProxy* New();
  vtkTypeMacro(vtkSMQuadrilleSourceProxy, vtkSMSourceProxy);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Called when a property of the filter, or what is before it, has changed.
  void MarkDirty(vtkSMProxy* modifiedProxy) override;

protected:
  vtkSMQuadrilleSourceProxy();
  ~vtkSMQuadrilleSourceProxy() override;

  /// Called when the filter has executed, whoever asked for it: a view, a reader of its data, a script.
  void PostUpdateData(bool usingCache) override;

  /// Called when something takes an output of the filter as its input, a representation for example.
  void AddConsumer(vtkSMProperty* property, vtkSMProxy* consumer) override;

private:
  vtkSMQuadrilleSourceProxy(const vtkSMQuadrilleSourceProxy&) = delete;
  void operator=(const vtkSMQuadrilleSourceProxy&) = delete;

  void NoteColours(vtkObject* changed, unsigned long, void*);
  bool HadColours(vtkSMProperty* colours) const;

  std::vector<vtkWeakPointer<vtkSMProperty>>
    Coloured; ///< of representations that get no colours any more
};

#endif
