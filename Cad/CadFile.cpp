// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Cad/CadFile.h"

#include "Base/Refuse.h"
#include "Cad/CadFormat.h"
#include "Cad/Curvatures.h"
#include "Cad/Guarded.h"
#include "Cad/Heal.h"
#include "Cad/Isolated.h"
#include "Cad/PartBytes.h"
#include "Cad/ShapeData.h"

#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BinTools.hxx>
#include <IGESCAFControl_Reader.hxx>
#include <IGESData_GlobalSection.hxx>
#include <IGESData_IGESModel.hxx>
#include <Interface_Static.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Controller.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <STEPControl_Reader.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TCollection_AsciiString.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDF_Label.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp.hxx>
#include <TopLoc_Location.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Compound.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>

#include <algorithm>
#include <cctype>
#include <deque>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

namespace quadrille
{

namespace
{

constexpr std::size_t kLineOfIges = 72; // where the letter of the section is, after the text

/// What a file of the format begins with, after which the reader is asked at all.
std::string damageAtBegin(const std::string& path, CadFormat format)
{
  std::ifstream file(path, std::ios::binary);
  if (!file)
  {
    return "no such file, or it cannot be opened for reading";
  }
  std::string start(4096, '\0');
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(file.gcount()));
  if (start.empty())
  {
    return "the file is empty";
  }
  if (format == CadFormat::Step && start.find("ISO-10303-21") == std::string::npos)
  {
    return "is no STEP file: ISO-10303-21 is not at its begin";
  }
  if (format == CadFormat::Iges &&
    (start.size() <= kLineOfIges ||
      (start[kLineOfIges] != 'S' && start[kLineOfIges] != 'C' && start[kLineOfIges] != 'B')))
  {
    return "is no IGES file: its first line is none of a start section";
  }
  if (format == CadFormat::Brep && start.find("CASCADE Topology") == std::string::npos &&
    start.find("Open CASCADE") == std::string::npos)
  {
    return "is no BREP file of Open CASCADE";
  }
  return {};
}

/// Its last bytes.
std::string endOf(const std::string& path)
{
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const auto size = static_cast<std::streamoff>(file.tellg());
  const std::streamoff from = std::max<std::streamoff>(0, size - 4096);
  file.seekg(from);
  std::string end(static_cast<std::size_t>(size - from), '\0');
  file.read(end.data(), static_cast<std::streamsize>(end.size()));
  return end;
}

/// STEP files end with a word of their own; without it the rest is missing.
bool endsAsStep(const std::string& path)
{
  return endOf(path).find("END-ISO-10303-21") != std::string::npos;
}

/// The last line says T, for termination, in its column 73.
bool endsAsIges(const std::string& path)
{
  constexpr std::size_t kColumn = 72;
  std::string end = endOf(path);
  end.resize(end.find_last_not_of(" \r\n") + 1);
  const std::string line = end.substr(end.find_last_of("\r\n") + 1);
  return line.size() > kColumn && line[kColumn] == 'T';
}

void tellEnd(bool isWhole, CadFile& file)
{
  if (!isWhole)
  {
    file.notices.push_back("the end of the file is missing: what was in it is, too");
  }
}

//------------------------------------------------------------------------------
std::string nameOf(const TDF_Label& label)
{
  Handle(TDataStd_Name) name;
  if (label.IsNull() || !label.FindAttribute(TDataStd_Name::GetID(), name))
  {
    return {};
  }
  std::string text(static_cast<std::size_t>(name->Get().LengthOfCString()) + 1, '\0');
  Standard_PCharacter characters = text.data();
  name->Get().ToUTF8CString(characters);
  text.resize(text.find('\0') == std::string::npos ? text.size() : text.find('\0'));
  const auto first = text.find_first_not_of(" \t\r\n");
  text = first == std::string::npos
    ? ""
    : text.substr(first, text.find_last_not_of(" \t\r\n") + 1 - first);
  return text == "NONE" ? "" : text; // which many programs write where there is none
}

/// Open CASCADE calls instances without a name by their label, "=>[0:1:1:2]", and shapes by their type.
bool isMadeUp(const std::string& name)
{
  static const std::set<std::string> types{ "SOLID", "SHELL", "FACE", "COMPOUND", "COMPSOLID",
    "WIRE", "EDGE", "VERTEX", "SHAPE", "ASSEMBLY" };
  return name.empty() || name.rfind("=>", 0) == 0 || types.count(name) > 0;
}

std::optional<std::array<double, 3>> colourOf(
  const Handle(XCAFDoc_ColorTool) & colours, const TDF_Label& label)
{
  Quantity_Color colour;
  for (const XCAFDoc_ColorType type : { XCAFDoc_ColorSurf, XCAFDoc_ColorGen })
  {
    if (!colours.IsNull() && colours->GetColor(label, type, colour))
    {
      return std::array<double, 3>{ colour.Red(), colour.Green(), colour.Blue() };
    }
  }
  return std::nullopt;
}

/// Walks over the assembly and collects its leaves.
class PartCollector
{
public:
  PartCollector(CadFile& file, const Handle(TDocStd_Document) & document) : file_(file)
  {
    if (!document.IsNull())
    {
      shapes_ = XCAFDoc_DocumentTool::ShapeTool(document->Main());
      colours_ = XCAFDoc_DocumentTool::ColorTool(document->Main());
    }
  }

  void collect()
  {
    TDF_LabelSequence roots;
    shapes_->GetFreeShapes(roots);
    for (const TDF_Label& root : roots)
    {
      walk(root, "", TopLoc_Location(), std::nullopt);
    }
  }

  /// As one part, where none is a solid: IGES files have a surface as so many faces, none of which knows another one.
  void collectSheets(const std::string& name)
  {
    TDF_LabelSequence roots;
    shapes_->GetFreeShapes(roots);
    BRep_Builder builder;
    TopoDS_Compound all;
    builder.MakeCompound(all);
    for (const TDF_Label& root : roots)
    {
      builder.Add(all, XCAFDoc_ShapeTool::GetShape(root));
    }
    TopTools_IndexedMapOfShape solids;
    TopExp::MapShapes(all, TopAbs_SOLID, solids);
    if (roots.Length() < 2 || solids.Extent() > 0)
    {
      collect();
      return;
    }
    addPart(roots, name, TopLoc_Location(), std::nullopt, all);
  }

  /// labels: of the shape, or of those that it is made of.
  void addPart(const TDF_LabelSequence& labels, const std::string& name,
    const TopLoc_Location& location, std::optional<std::array<double, 3>> colour,
    const TopoDS_Shape& shape)
  {
    const HealedShape& healed = healedShape(shape, name);
    const auto data = std::make_shared<const CadShape::Data>(healed.shape.Moved(location));
    if (data->faces.IsEmpty())
    {
      file_.notices.push_back(
        (name.empty() ? "a part" : name) + ": has no faces, so that it is left out");
      return;
    }
    CadPart part;
    part.name = uniqueName(name);
    part.shape = CadShape(data);
    part.faceNames.resize(static_cast<std::size_t>(data->faces.Extent()));
    part.edgeNames.resize(static_cast<std::size_t>(data->edges.Extent()));
    part.vertexNames.resize(static_cast<std::size_t>(data->vertices.Extent()));
    part.faceColours.assign(part.faceNames.size(), colour);
    for (const TDF_Label& label : labels)
    {
      nameSubShape(label, healed, location, *data, part);
      nameSubShapes(label, healed, location, *data, part);
    }
    file_.parts.push_back(std::move(part));
  }

private:
  /// Instances of a shape are healed once, and have what is healed in common.
  const HealedShape& healedShape(const TopoDS_Shape& shape, const std::string& name)
  {
    const auto known = std::find_if(
      healed_.begin(), healed_.end(), [&](const auto& one) { return one.first.IsEqual(shape); });
    if (known != healed_.end())
    {
      return known->second;
    }
    healed_.emplace_back(shape, healShape(shape));
    for (const std::string& repair : healed_.back().second.repairs)
    {
      file_.notices.push_back((name.empty() ? "" : name + ": ") + repair);
    }
    return healed_.back().second;
  }

  void walk(const TDF_Label& label, const std::string& instance, const TopLoc_Location& location,
    std::optional<std::array<double, 3>> colour)
  {
    const std::string own = nameOf(label);
    const std::string name = isMadeUp(instance) ? (isMadeUp(own) ? "" : own) : instance;
    const auto ownColour = colourOf(colours_, label);
    colour = ownColour ? ownColour : colour;
    if (XCAFDoc_ShapeTool::IsAssembly(label))
    {
      TDF_LabelSequence components;
      XCAFDoc_ShapeTool::GetComponents(label, components);
      for (const TDF_Label& component : components)
      {
        TDF_Label referred;
        if (XCAFDoc_ShapeTool::GetReferredShape(component, referred))
        {
          const auto ofInstance = colourOf(colours_, component);
          walk(referred, nameOf(component), location * XCAFDoc_ShapeTool::GetLocation(component),
            ofInstance ? ofInstance : colour);
        }
      }
      return;
    }
    const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(label);
    if (!shape.IsNull())
    {
      TDF_LabelSequence labels;
      labels.Append(label);
      addPart(labels, name, location, colour, shape);
    }
  }

  std::string uniqueName(const std::string& name)
  {
    const std::string base = name.empty() ? "PART" : name;
    std::string found = base;
    for (int i = 2; !names_.insert(found).second; ++i)
    {
      found = base + "_" + std::to_string(i);
    }
    return found;
  }

  void nameSubShapes(const TDF_Label& label, const HealedShape& healed,
    const TopLoc_Location& location, const CadShape::Data& data, CadPart& part) const
  {
    TDF_LabelSequence labels;
    XCAFDoc_ShapeTool::GetSubShapes(label, labels);
    for (const TDF_Label& sub : labels)
    {
      nameSubShape(sub, healed, location, data, part);
    }
  }

  void nameSubShape(const TDF_Label& label, const HealedShape& healed,
    const TopLoc_Location& location, const CadShape::Data& data, CadPart& part) const
  {
    const TopoDS_Shape before = XCAFDoc_ShapeTool::GetShape(label);
    const TopoDS_Shape now = before.IsNull() ? before : healed.healed(before);
    if (!now.IsNull())
    {
      nameShape(label, now.Moved(location), data, part);
    }
  }

  void nameShape(const TDF_Label& label, const TopoDS_Shape& shape, const CadShape::Data& data,
    CadPart& part) const
  {
    const std::string name = nameOf(label);
    const auto place = [&](const TopTools_IndexedMapOfShape& map)
    { return static_cast<std::size_t>(map.FindIndex(shape)); };
    const auto setName = [&](std::size_t number, std::vector<std::string>& names)
    {
      if (number > 0 && !isMadeUp(name))
      {
        names[number - 1] = name;
      }
    };
    setName(place(data.faces), part.faceNames);
    setName(place(data.edges), part.edgeNames);
    setName(place(data.vertices), part.vertexNames);
    const auto colour = colourOf(colours_, label);
    if (!colour)
    {
      return;
    }
    TopTools_IndexedMapOfShape faces; // also of a solid with a colour of its own
    TopExp::MapShapes(shape, TopAbs_FACE, faces);
    for (int i = 1; i <= faces.Extent(); ++i)
    {
      if (const int number = data.faces.FindIndex(faces(i)); number > 0)
      {
        part.faceColours[static_cast<std::size_t>(number) - 1] = colour;
      }
    }
  }

  CadFile& file_;
  Handle(XCAFDoc_ShapeTool) shapes_;
  Handle(XCAFDoc_ColorTool) colours_;
  std::set<std::string> names_;
  std::deque<std::pair<TopoDS_Shape, HealedShape>> healed_; ///< by the shape before
};

//------------------------------------------------------------------------------
/// Sets a setting of Open CASCADE's readers, and back at the end.
class SettingScope
{
public:
  SettingScope(const char* name, const char* value)
    : name_(name), before_(Interface_Static::CVal(name))
  {
    Interface_Static::SetCVal(name, value);
  }
  SettingScope(const SettingScope&) = delete;
  SettingScope& operator=(const SettingScope&) = delete;
  ~SettingScope() { Interface_Static::SetCVal(name_, before_.c_str()); }

private:
  const char* name_;
  std::string before_;
};

std::string lower(std::string text)
{
  std::transform(text.begin(), text.end(), text.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// Open CASCADE reads in millimetres. Its tolerances are lengths without a unit, so that in metres it joins vertices
/// and loses edges that are a hundredth of a millimetre long.
void tellUnit(const std::string& unit, CadFile& file)
{
  file.unit = unit;
  if (unit.empty())
  {
    file.notices.push_back("the file does not say its unit of length: millimetres are assumed");
  }
  else if (unit != "millimetre")
  {
    file.notices.push_back(
      "the unit of the file is the " + unit + "; coordinates are in millimetres");
  }
}

const char* wordsOf(IFSelect_ReturnStatus status)
{
  return status == IFSelect_RetError ? "its data cannot be read"
    : status == IFSelect_RetFail     ? "its text cannot be read"
    : status == IFSelect_RetVoid     ? "it holds no data"
                                     : "reading was stopped";
}

Handle(TDocStd_Document) newDocument()
{
  return new TDocStd_Document("BinXCAF");
}

void readStep(const std::string& path, CadFile& file)
{
  STEPCAFControl_Controller::Init();
  const SettingScope names("read.stepcaf.subshapes.name", "1");
  STEPCAFControl_Reader reader;
  reader.SetNameMode(Standard_True);
  reader.SetColorMode(Standard_True);
  reader.SetLayerMode(Standard_False);
  reader.SetPropsMode(Standard_False);
  const IFSelect_ReturnStatus status = reader.ReadFile(path.c_str());
  refuseIf(status != IFSelect_RetDone, path, ": is damaged: ", wordsOf(status),
    endsAsStep(path) ? "" : ", and its end is missing");
  TColStd_SequenceOfAsciiString lengths, angles, solidAngles;
  reader.ChangeReader().FileUnits(lengths, angles, solidAngles);
  const std::string unit = lengths.IsEmpty() ? "" : lower(lengths.First().ToCString());
  const SettingScope units("xstep.cascade.unit", "MM");
  Handle(TDocStd_Document) document = newDocument();
  refuseIf(!reader.Transfer(document), path, ": is damaged: no shape can be made of its data");
  tellUnit(unit, file);
  tellEnd(endsAsStep(path), file);
  PartCollector(file, document).collect();
}

void readIges(const std::string& path, CadFile& file)
{
  IGESCAFControl_Reader reader;
  reader.SetNameMode(Standard_True);
  reader.SetColorMode(Standard_True);
  reader.SetLayerMode(Standard_False);
  const IFSelect_ReturnStatus status = reader.ReadFile(path.c_str());
  refuseIf(status != IFSelect_RetDone, path, ": is damaged: ", wordsOf(status),
    endsAsIges(path) ? "" : ", and its end is missing");
  const Handle(TCollection_HAsciiString) name = reader.IGESModel()->GlobalSection().UnitName();
  const std::string word = name.IsNull() ? "" : lower(name->ToCString());
  const std::string unit = word == "m" ? "metre"
    : word == "mm"                     ? "millimetre"
    : word == "in" || word == "inch"   ? "inch"
                                       : word;
  const SettingScope units("xstep.cascade.unit", "MM");
  Handle(TDocStd_Document) document = newDocument();
  refuseIf(!reader.Transfer(document), path, ": is damaged: no shape can be made of its data");
  tellUnit(unit, file);
  tellEnd(endsAsIges(path), file);
  PartCollector(file, document).collectSheets(std::filesystem::path(path).stem().string());
}

void readBrep(const std::string& path, CadFile& file)
{
  TopoDS_Shape shape;
  BRep_Builder builder;
  const bool isRead =
    BRepTools::Read(shape, path.c_str(), builder) || BinTools::Read(shape, path.c_str());
  refuseIf(!isRead || shape.IsNull(), path, ": is damaged: no shape can be made of its data");
  PartCollector(file, nullptr)
    .addPart(TDF_LabelSequence(), std::filesystem::path(path).stem().string(), TopLoc_Location(),
      std::nullopt, shape);
}

CadPart joinedParts(const CadFile& file)
{
  if (file.parts.size() == 1)
  {
    return file.parts.front();
  }
  CadPart all;
  all.name = "ASSEMBLY";
  std::shared_ptr<const CadShape::Data> data;
  guarded("the parts as one shape",
    [&]
    {
      BRep_Builder builder;
      TopoDS_Compound compound;
      builder.MakeCompound(compound);
      for (const CadPart& part : file.parts)
      {
        builder.Add(compound, part.shape.data()->shape);
      }
      data = std::make_shared<const CadShape::Data>(compound);
    });
  all.shape = CadShape(data);
  all.faceNames.resize(all.shape.faceCount());
  all.edgeNames.resize(all.shape.edgeCount());
  all.vertexNames.resize(all.shape.vertexCount());
  all.faceColours.resize(all.shape.faceCount());
  // word: of those without a name, with their number; empty: they have none.
  const auto copyNames = [](const CadPart& part, const std::vector<std::string>& from,
                           const TopTools_IndexedMapOfShape& own,
                           const TopTools_IndexedMapOfShape& map, const std::string& word,
                           std::vector<std::string>& to)
  {
    for (std::size_t i = 0; i < from.size(); ++i)
    {
      const auto number = static_cast<std::size_t>(map.FindIndex(own(static_cast<int>(i) + 1)));
      const std::string name =
        from[i].empty() && !word.empty() ? word + std::to_string(i + 1) : from[i];
      if (number > 0 && !name.empty())
      {
        to[number - 1] = part.name + "/" + name;
      }
    }
  };
  for (const CadPart& part : file.parts)
  {
    const CadShape::Data& own = *part.shape.data();
    copyNames(part, part.faceNames, own.faces, data->faces, kUnnamedFace, all.faceNames);
    copyNames(part, part.edgeNames, own.edges, data->edges, "", all.edgeNames);
    copyNames(part, part.vertexNames, own.vertices, data->vertices, "", all.vertexNames);
    for (std::size_t i = 0; i < part.faceColours.size(); ++i)
    {
      const int number = data->faces.FindIndex(own.faces(static_cast<int>(i) + 1));
      all.faceColours[static_cast<std::size_t>(number) - 1] = part.faceColours[i];
    }
  }
  return all;
}

/// Of the parts in their order. Instances of a shape get the triangles of the first one, at their places.
void tessellateParts(const TessellationOptions& options, std::vector<CadPart>& parts)
{
  for (std::size_t i = 0; i < parts.size(); ++i)
  {
    const TopoDS_Shape& shape = parts[i].shape.data()->shape;
    const auto first = std::find_if(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(i),
      [&](const CadPart& part)
      {
        const TopoDS_Shape& other = part.shape.data()->shape;
        return other.IsPartner(shape) && other.Orientation() == shape.Orientation();
      });
    const bool isInstance = first != parts.begin() + static_cast<std::ptrdiff_t>(i);
    const gp_Trsf move = isInstance
      ? (shape.Location() * first->shape.data()->shape.Location().Inverted()).Transformation()
      : gp_Trsf();
    if (!isInstance || move.IsNegative())
    {
      parts[i].surface = tessellate(parts[i].shape, options);
      addCurvatures(parts[i].shape, parts[i].surface);
      continue;
    }
    parts[i].surface = first->surface;
    for (Vector3& p : parts[i].surface.points)
    {
      const gp_Pnt moved = gp_Pnt(p.x(), p.y(), p.z()).Transformed(move);
      p = { moved.X(), moved.Y(), moved.Z() };
    }
  }
}

/// In this process.
CadFile readHere(const std::string& path, CadFormat format, const CadReadOptions& options)
{
  CadFile file;
  const std::string failures = guarded(path,
    [&]
    {
      const auto read = format == CadFormat::Step ? readStep
        : format == CadFormat::Iges               ? readIges
                                                  : readBrep;
      read(path, file);
    });
  refuseIf(file.parts.empty(), path, ": holds no faces",
    failures.empty() ? "" : "; Open CASCADE tells: " + failures.substr(0, failures.find('\n')));
  if (options.joined)
  {
    CadPart all = joinedParts(file);
    file.parts = { std::move(all) };
  }
  tessellateParts(options.tessellation, file.parts);
  for (const CadPart& part : file.parts)
  {
    for (const std::string& notice : part.surface.notices)
    {
      file.notices.push_back(part.name + ": " + notice);
    }
  }
  return file;
}

/// Ten times what parts take that are slow to read.
double timeLimitOf(const std::string& path)
{
  constexpr double kLeast = 20, kOfMegabyte = 10;
  std::error_code code;
  const auto size = static_cast<double>(std::filesystem::file_size(path, code));
  return code ? kLeast : kLeast + kOfMegabyte * size / 1e6;
}

} // namespace

CadFile readCadFile(const std::string& path, const CadReadOptions& options)
{
  const std::optional<CadFormat> format = cadFormatOf(path);
  refuseIf(!format, path, ": unknown extension; CAD files are stp, step, igs, iges, brep and brp");
  const std::string damage = damageAtBegin(path, *format);
  refuseIf(!damage.empty(), path, ": ", damage);
  const double limit = options.timeLimit > 0 ? options.timeLimit : timeLimitOf(path);
  return fileOf(isolated(path, limit, [&] { return bytesOf(readHere(path, *format, options)); }));
}

} // namespace quadrille
