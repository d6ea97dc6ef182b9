// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMQuadrilleSourceProxy.h"

#include "QuadrilleHelp.h"

#include "vtkClientServerStream.h"
#include "vtkCommand.h"
#include "vtkDataObject.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPVDataInformation.h"
#include "vtkPVXMLElement.h"
#include "vtkSMInputProperty.h"
#include "vtkSMParaViewPipelineController.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxyManager.h"
#include "vtkSMSession.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMUndoStackBuilder.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <cstring>
#include <set>
#include <string>
#include <vector>

vtkStandardNewMacro(vtkSMQuadrilleSourceProxy);

namespace
{

/// Which output of the producer the property was connected to last; -1 where it is none.
int connectedPort(vtkSMProperty* property, vtkSMProxy* producer)
{
  auto* input = vtkSMInputProperty::SafeDownCast(property);
  int port = -1;
  for (unsigned int i = 0; input && i < input->GetNumberOfProxies(); ++i)
  {
    if (input->GetProxy(i) == producer)
    {
      port = static_cast<int>(input->GetOutputPortForConnection(i));
    }
  }
  return port;
}

void applyDisplayHints(vtkPVXMLElement* hints, int port, vtkSMProxy* representation)
{
  for (unsigned int i = 0; hints && i < hints->GetNumberOfNestedElements(); ++i)
  {
    vtkPVXMLElement* hint = hints->GetNestedElement(i);
    int wanted = -1;
    double value = 0;
    const char* name = hint->GetAttribute("property");
    if (std::strcmp(hint->GetName(), "Display") == 0 && name &&
      hint->GetScalarAttribute("port", &wanted) && wanted == port &&
      hint->GetScalarAttribute("value", &value) && representation->GetProperty(name))
    {
      vtkSMPropertyHelper(representation, name).Set(value);
    }
  }
}

void makeOnDemand(vtkPVXMLElement* hints, int port, vtkSMProxy* filter)
{
  for (unsigned int i = 0; hints && i < hints->GetNumberOfNestedElements(); ++i)
  {
    vtkPVXMLElement* hint = hints->GetNestedElement(i);
    int wanted = -1;
    const char* name = hint->GetAttribute("property");
    if (std::strcmp(hint->GetName(), "OnDemand") == 0 && name && filter->GetProperty(name) &&
      hint->GetScalarAttribute("port", &wanted) && wanted == port)
    {
      vtkSMPropertyHelper(filter, name).Set(1);
      filter->UpdateProperty(name);
    }
  }
}

/// The array of cells by which an output is to be coloured; null where the hints name none.
const char* colouringArray(vtkPVXMLElement* hints, int port)
{
  for (unsigned int i = 0; hints && i < hints->GetNumberOfNestedElements(); ++i)
  {
    vtkPVXMLElement* hint = hints->GetNestedElement(i);
    int wanted = -1;
    if (std::strcmp(hint->GetName(), "Colour") == 0 && hint->GetScalarAttribute("port", &wanted) &&
      wanted == port)
    {
      return hint->GetAttribute("cells");
    }
  }
  return nullptr;
}

/// The property of a representation that names the array by which it is coloured; null where it has none.
vtkSMProperty* coloursOf(vtkSMProxy* representation)
{
  return representation->GetProperty("ColorArrayName");
}

bool hasColours(vtkSMProperty* colours)
{
  constexpr unsigned int name = 4; // of the array, behind how it is found
  const vtkSMPropertyHelper helper(colours, true);
  return helper.GetNumberOfElements() > name && std::strlen(helper.GetAsString(name)) > 0;
}

/// What is changed meanwhile is not on the stack of undos, where there is one.
class NoStepOfTheUser
{
public:
  NoStepOfTheUser()
  {
    if (this->Builder)
    {
      this->Builder->SetIgnoreAllChanges(true);
    }
  }
  ~NoStepOfTheUser()
  {
    if (this->Builder)
    {
      this->Builder->SetIgnoreAllChanges(this->Before);
    }
  }
  NoStepOfTheUser(const NoStepOfTheUser&) = delete;
  NoStepOfTheUser& operator=(const NoStepOfTheUser&) = delete;

private:
  vtkSMUndoStackBuilder* Builder = vtkSMProxyManager::GetProxyManager()->GetUndoStackBuilder();
  bool Before = this->Builder && this->Builder->GetIgnoreAllChanges();
};

/// When there are cells with the array: ParaView chooses colours when a representation is made, and not again; set
/// before, it warns that the array has no range, and shows a legend of nothing.
void colour(vtkSMProxy* representation, const char* array, vtkSMSessionProxyManager* manager)
{
  if (!coloursOf(representation) || !representation->GetProperty("LookupTable"))
  {
    return;
  }
  vtkSMPropertyHelper(representation, "ColorArrayName")
    .SetInputArrayToProcess(vtkDataObject::CELL, array);
  const std::string table = std::string(array) + ".PVLookupTable";
  vtkSMPropertyHelper(representation, "LookupTable")
    .Set(manager->GetProxy("lookup_tables", table.c_str()));
  representation->UpdateVTKObjects();
}

/// ParaView looks for the cell that it picks under the mouse in the first output, whatever output it was drawn of.
void letPicksThrough(int port, vtkSMProxy* representation)
{
  if (port > 0 && representation->GetProperty("Pickable"))
  {
    vtkSMPropertyHelper(representation, "Pickable").Set(0);
  }
}

/// Values, their names, and their colours one after the other.
struct Entries
{
  std::vector<std::string> annotations;
  std::vector<double> colours;
};

Entries readEntries(vtkPVXMLElement* map)
{
  Entries entries;
  for (unsigned int i = 0; i < map->GetNumberOfNestedElements(); ++i)
  {
    vtkPVXMLElement* entry = map->GetNestedElement(i);
    double colour[3];
    if (entry->GetAttribute("value") && entry->GetAttribute("text") &&
      entry->GetScalarAttribute("red", &colour[0]) &&
      entry->GetScalarAttribute("green", &colour[1]) &&
      entry->GetScalarAttribute("blue", &colour[2]))
    {
      entries.annotations.emplace_back(entry->GetAttribute("value"));
      entries.annotations.emplace_back(entry->GetAttribute("text"));
      entries.colours.insert(entries.colours.end(), colour, colour + 3);
    }
  }
  return entries;
}

/// The opacity function of an array, by the name by which ParaView finds it.
vtkSMProxy* opacityOf(const std::string& array, vtkSMSessionProxyManager* manager)
{
  const std::string name = array + ".PiecewiseFunction";
  if (vtkSMProxy* found = manager->GetProxy("piecewise_functions", name.c_str()))
  {
    return found;
  }
  auto made = vtkSmartPointer<vtkSMProxy>::Take(
    manager->NewProxy("piecewise_functions", "PiecewiseFunction"));
  vtkNew<vtkSMParaViewPipelineController> controller;
  controller->InitializeProxy(made);
  made->UpdateVTKObjects();
  controller->RegisterOpacityTransferFunction(made, name.c_str());
  return made; // the manager holds it
}

/// Under the name by which ParaView finds the colour map of an array.
void makeColourMap(vtkPVXMLElement* map, vtkSMSessionProxyManager* manager)
{
  const std::string name = std::string(map->GetAttributeOrEmpty("array")) + ".PVLookupTable";
  if (manager->GetProxy("lookup_tables", name.c_str()))
  {
    return;
  }
  auto table =
    vtkSmartPointer<vtkSMProxy>::Take(manager->NewProxy("lookup_tables", "PVLookupTable"));
  if (!table)
  {
    return; // a client without views
  }
  const Entries entries = readEntries(map);
  vtkNew<vtkSMParaViewPipelineController> controller;
  controller->PreInitializeProxy(table);
  // The editor of colour maps does not work without one.
  vtkSMPropertyHelper(table, "ScalarOpacityFunction")
    .Set(opacityOf(map->GetAttributeOrEmpty("array"), manager));
  vtkSMPropertyHelper(table, "IndexedLookup").Set(1);
  vtkSMPropertyHelper annotations(table, "Annotations");
  for (std::size_t i = 0; i < entries.annotations.size(); ++i)
  {
    annotations.Set(static_cast<unsigned int>(i), entries.annotations[i].c_str());
  }
  vtkSMPropertyHelper(table, "IndexedColors")
    .Set(entries.colours.data(), static_cast<unsigned int>(entries.colours.size()));
  vtkSMPropertyHelper(table, "AnnotationsInitialized").Set(1);
  controller->PostInitializeProxy(table);
  table->UpdateVTKObjects();
  controller->RegisterColorTransferFunctionProxy(table, name.c_str());
}

void makeColourMaps(vtkPVXMLElement* hints, vtkSMSessionProxyManager* manager)
{
  for (unsigned int i = 0; hints && i < hints->GetNumberOfNestedElements(); ++i)
  {
    if (std::strcmp(hints->GetNestedElement(i)->GetName(), "ColourMap") == 0)
    {
      makeColourMap(hints->GetNestedElement(i), manager);
    }
  }
}

bool isRepresentation(vtkSMProxy* proxy)
{
  const char* group = proxy ? proxy->GetXMLGroup() : nullptr;
  return group && std::strcmp(group, "representations") == 0;
}

/// Tells the representations of the producer, and of all filters behind it, to update when they are next shown.
void markRepresentations(vtkSMProxy* producer, std::set<vtkSMProxy*>& visited)
{
  for (unsigned int i = 0; i < producer->GetNumberOfConsumers(); ++i)
  {
    vtkSMProxy* consumer = producer->GetConsumerProxy(i);
    if (!consumer || !consumer->GetObjectsCreated() || !visited.insert(consumer).second)
    {
      continue;
    }
    if (isRepresentation(consumer))
    {
      vtkClientServerStream stream;
      stream << vtkClientServerStream::Invoke << VTKOBJECT(consumer) << "MarkModified"
             << vtkClientServerStream::End;
      consumer->GetSession()->ExecuteStream(consumer->GetLocation(), stream);
    }
    else if (vtkSMSourceProxy::SafeDownCast(consumer))
    {
      markRepresentations(consumer, visited);
    }
  }
}

} // namespace

vtkSMQuadrilleSourceProxy::vtkSMQuadrilleSourceProxy()
{
  quadrille::allowHelpPages(); // ParaView loads plug-ins before it has a window
}
vtkSMQuadrilleSourceProxy::~vtkSMQuadrilleSourceProxy() = default;

//------------------------------------------------------------------------------
void vtkSMQuadrilleSourceProxy::PostUpdateData(bool usingCache)
{
  this->Superclass::PostUpdateData(usingCache);
  this->UpdatePropertyInformation();
  for (unsigned int i = 0; i < this->GetNumberOfConsumers(); ++i)
  {
    vtkSMProxy* consumer = this->GetConsumerProxy(i);
    const int port = connectedPort(this->GetConsumerProperty(i), this);
    const char* array = port < 0 ? nullptr : colouringArray(this->GetHints(), port);
    vtkSMProperty* colours = isRepresentation(consumer) ? coloursOf(consumer) : nullptr;
    if (array && colours && !hasColours(colours) && !this->HadColours(colours) &&
      this->GetDataInformation(static_cast<unsigned int>(port))->GetNumberOfCells() > 0)
    {
      const NoStepOfTheUser notUndone;
      colour(consumer, array, this->GetSessionProxyManager());
    }
  }
}

//------------------------------------------------------------------------------
void vtkSMQuadrilleSourceProxy::NoteColours(vtkObject* changed, unsigned long, void*)
{
  auto* colours = vtkSMProperty::SafeDownCast(changed);
  if (hasColours(colours) && !this->HadColours(colours))
  {
    this->Coloured.emplace_back(colours);
  }
}

//------------------------------------------------------------------------------
bool vtkSMQuadrilleSourceProxy::HadColours(vtkSMProperty* colours) const
{
  return std::find(this->Coloured.begin(), this->Coloured.end(), colours) != this->Coloured.end();
}

//------------------------------------------------------------------------------
void vtkSMQuadrilleSourceProxy::MarkDirty(vtkSMProxy* modifiedProxy)
{
  this->Superclass::MarkDirty(modifiedProxy);
  std::set<vtkSMProxy*> visited;
  markRepresentations(this, visited);
}

//------------------------------------------------------------------------------
void vtkSMQuadrilleSourceProxy::AddConsumer(vtkSMProperty* property, vtkSMProxy* consumer)
{
  this->Superclass::AddConsumer(property, consumer);
  const int port = connectedPort(property, this);
  if (port >= 0)
  {
    makeOnDemand(this->GetHints(), port, this);
  }
  if (isRepresentation(consumer))
  {
    vtkSMProperty* colours = coloursOf(consumer);
    if (colours && this->GetSessionProxyManager()->GetInLoadXMLState())
    {
      this->Coloured.emplace_back(colours);
    }
    else if (colours)
    {
      colours->AddObserver(
        vtkCommand::ModifiedEvent, this, &vtkSMQuadrilleSourceProxy::NoteColours);
    }
    makeColourMaps(this->GetHints(), this->GetSessionProxyManager());
    letPicksThrough(port, consumer);
    applyDisplayHints(this->GetHints(), port, consumer);
  }
}

//------------------------------------------------------------------------------
void vtkSMQuadrilleSourceProxy::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}
