// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Native/Files.h"

#include "Base/Refuse.h"
#include "Export/InpWriter.h"
#include "Export/MshWriter.h"
#include "Export/OutputFile.h"
#include "Export/SurfaceWriters.h"
#include "Import/SurfaceFile.h"
#include "Native/Arrays.h"
#include "Native/Errors.h"
#include "Native/ProgressCall.h"

#include <pybind11/stl.h>

#include <string>
#include <utility>
#include <vector>

namespace quadrille::native
{

namespace
{

//------------------------------------------------------------------------------
// Reading

py::dtype dtypeOf(NumberType type)
{
  switch (type)
  {
    case NumberType::Int8:
      return py::dtype::of<std::int8_t>();
    case NumberType::UInt8:
      return py::dtype::of<std::uint8_t>();
    case NumberType::Int16:
      return py::dtype::of<std::int16_t>();
    case NumberType::UInt16:
      return py::dtype::of<std::uint16_t>();
    case NumberType::Int32:
      return py::dtype::of<std::int32_t>();
    case NumberType::UInt32:
      return py::dtype::of<std::uint32_t>();
    case NumberType::Int64:
      return py::dtype::of<std::int64_t>();
    case NumberType::Float32:
      return py::dtype::of<float>();
    default:
      return py::dtype::of<double>();
  }
}

/// The array takes over the memory.
py::array takeOver(NumberArray& numbers)
{
  std::vector<py::ssize_t> shape{ static_cast<py::ssize_t>(numbers.rows()) };
  if (numbers.components() > 1)
  {
    shape.push_back(static_cast<py::ssize_t>(numbers.components()));
  }
  unsigned char* const bytes = numbers.release().release();
  const py::capsule owner(bytes, [](void* memory) { std::free(memory); });
  return py::array(dtypeOf(numbers.type()), shape, bytes, owner);
}

py::object cellsOrNone(FileCells& cells)
{
  return cells.empty() ? py::object(py::none())
                       : py::make_tuple(takeOver(cells.offsets), takeOver(cells.ids));
}

py::dict arraysDict(std::vector<FileArray>& arrays)
{
  py::dict dict;
  for (FileArray& array : arrays)
  {
    dict[py::str(array.name)] = takeOver(array.numbers);
  }
  return dict;
}

SurfaceFile readSurfaceFile(const std::string& path, const std::string& extension)
{
  if (extension == "ply")
  {
    return readPly(path);
  }
  if (extension == "off")
  {
    return readOff(path);
  }
  if (extension == "obj")
  {
    return readObj(path);
  }
  return isBinaryStl(path) ? readBinaryStl(path) : readTextStl(path);
}

/// Points, polygons and strips (offsets and ids, or None), point data, cell data.
py::tuple readCall(const std::string& path)
{
  SurfaceFile file = withoutLock([&] { return readSurfaceFile(path, extensionOf(path)); });
  return py::make_tuple(takeOver(file.points), cellsOrNone(file.polygons), cellsOrNone(file.strips),
    arraysDict(file.pointData), arraysDict(file.cellData));
}

//------------------------------------------------------------------------------
// Writing

/// mesh: "points", "elements" (n by 4, 8 or 9), "patches" (numbers and names), "patch_of", and of "feature_edges",
/// "thickness" and "axis" what there is.
ElementMesh elementsFrom(const py::dict& mesh)
{
  ElementMesh elements;
  elements.nodes = vectorsFrom(mesh["points"].cast<ArrayOf<double>>());
  const auto ids = mesh["elements"].cast<ArrayOf<std::int64_t>>();
  elements.nodesPerElement = static_cast<int>(ids.shape(1));
  elements.elements.assign(ids.data(), ids.data() + ids.size());
  for (const py::handle& patch : mesh["patches"])
  {
    const auto pair = patch.cast<std::pair<std::int64_t, std::string>>();
    elements.patches.push_back({ pair.first, pair.second });
  }
  const auto patchOf = valuesFrom(mesh["patch_of"].cast<ArrayOf<std::int64_t>>());
  elements.patchOf.assign(patchOf.begin(), patchOf.end());
  if (mesh.contains("feature_edges"))
  {
    elements.featureEdges = valuesFrom(mesh["feature_edges"].cast<ArrayOf<std::uint8_t>>());
  }
  if (mesh.contains("thickness"))
  {
    elements.thickness = valuesFrom(mesh["thickness"].cast<ArrayOf<double>>());
  }
  if (mesh.contains("axis"))
  {
    elements.axis = vectorsFrom(mesh["axis"].cast<ArrayOf<double>>());
  }
  return elements;
}

/// What the formats are asked for.
struct WriteOptions
{
  std::string element, material;
  int dialect = 0, mshVersion = 0;
  bool withPatches = false;  ///< groups in obj
  std::string patchProperty; ///< of ply
  bool inDouble = false;     ///< ply

  explicit WriteOptions(const py::dict& how)
    : element(how["element"].cast<std::string>()), material(how["material"].cast<std::string>()),
      dialect(how["dialect"].cast<int>()), mshVersion(how["msh_version"].cast<int>()),
      withPatches(how["with_patches"].cast<bool>()),
      patchProperty(how["patch_property"].cast<std::string>()),
      inDouble(how["in_double"].cast<bool>())
  {
  }
};

std::vector<std::string> writeElements(const ElementMesh& elements, const WriteOptions& how,
  const std::string& path, const ProgressCallback& told)
{
  const std::string extension = extensionOf(path);
  const MeshSets sets = setsOf(elements);
  if (extension == "inp")
  {
    return writeInp(elements, sets, path,
      { how.element, static_cast<InpDialect>(how.dialect), how.material, told });
  }
  if (extension == "msh")
  {
    return writeMsh(
      elements, sets, path, how.mshVersion == 0 ? MshVersion::V41 : MshVersion::V22, told);
  }
  if (extension == "mesh")
  {
    return writeMedit(elements, sets, path, told);
  }
  if (extension == "obj")
  {
    return writeObj(elements, sets, how.withPatches, path, told);
  }
  if (extension == "ply")
  {
    return writePly(elements, sets, how.patchProperty, how.inDouble, path, told);
  }
  return writeStl(elements, path, told);
}

/// Returns what the user should know.
std::vector<std::string> writeCall(
  const std::string& path, const py::dict& mesh, const py::dict& how, const py::object& progress)
{
  const ElementMesh elements = elementsFrom(mesh);
  const WriteOptions options(how);
  ProgressCall call(progress, true, 0);
  const ProgressCallback callback = call.callback(0, 1);
  std::vector<std::string> notices;
  try
  {
    withoutLock(
      [&]
      {
        PollScope polling(callback);
        const ProgressCallback told = polling.callback();
        writeThenRename(path,
          [&](const std::string& temporary)
          { notices = writeElements(elements, options, temporary, told); });
      });
  }
  catch (const Cancelled&)
  {
    call.rethrow();
    throw RunFailure(path + ": not written, as it was stopped");
  }
  catch (const InvalidInput& error)
  {
    refuse(path, ": ", error.what());
  }
  call.finish();
  call.rethrow();
  return notices;
}

} // namespace

void bindFiles(py::module_& module)
{
  module.def("read", &readCall);
  module.def("write", &writeCall);
}

} // namespace quadrille::native
