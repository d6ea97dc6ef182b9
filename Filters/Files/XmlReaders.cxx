// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Files/XmlReaders.h"

#include "vtkXMLDataParser.h"
#include "vtkXMLPolyDataReader.h"
#include "vtkXMLUnstructuredGridReader.h"

#include <dlfcn.h>

namespace quadrille
{
namespace
{

/// Has expat parse what it is given at once, where this expat could do otherwise.
class PromptParser : public vtkXMLDataParser
{
public:
  static PromptParser* New()
  {
    auto* parser = new PromptParser;
    parser->InitializeObjectBase();
    return parser;
  }
  vtkTypeMacro(PromptParser, vtkXMLDataParser);

protected:
  int CreateParser() override
  {
    using Setter = unsigned char (*)(void* parser, unsigned char enabled);
    static const auto set =
      reinterpret_cast<Setter>(dlsym(RTLD_DEFAULT, "XML_SetReparseDeferralEnabled"));
    const int made = this->Superclass::CreateParser();
    if (made != 0 && set != nullptr)
    {
      set(this->Parser, 0);
    }
    return made;
  }
};

template <class Reader>
class PromptReader : public Reader
{
public:
  static vtkSmartPointer<Reader> make()
  {
    auto* reader = new PromptReader;
    reader->InitializeObjectBase();
    return vtkSmartPointer<Reader>::Take(reader);
  }

protected:
  void CreateXMLParser() override
  {
    if (this->XMLParser != nullptr)
    {
      this->DestroyXMLParser();
    }
    this->XMLParser = PromptParser::New();
  }
};

} // namespace

vtkSmartPointer<vtkXMLPolyDataReader> newPolyDataReader()
{
  return PromptReader<vtkXMLPolyDataReader>::make();
}

vtkSmartPointer<vtkXMLUnstructuredGridReader> newUnstructuredGridReader()
{
  return PromptReader<vtkXMLUnstructuredGridReader>::make();
}

} // namespace quadrille
