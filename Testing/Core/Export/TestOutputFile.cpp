// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Export/OutputFile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

namespace quadrille
{

namespace
{

namespace fs = std::filesystem;

/// A folder that goes with the test.
class Folder
{
public:
  Folder()
  {
    std::string pattern = (fs::temp_directory_path() / "quadrilleXXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  ~Folder() { fs::remove_all(path_); }
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  std::size_t files() const
  {
    return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(path_), fs::directory_iterator()));
  }

private:
  fs::path path_;
};

std::string contentOf(const std::string& path)
{
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

} // namespace

TEST(RealText, ReadsBackToTheSameBits)
{
  for (const double x : { 0., 1., -1., 0.1, 1. / 3, 1e300, -1e-300, 123456789.125,
         std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::max() })
  {
    const std::string text = realText(x);
    EXPECT_EQ(std::strtod(text.c_str(), nullptr), x) << text;
    EXPECT_NE(text.find_first_of(".e"), std::string::npos) << text;
  }
}

/// 20 characters have room for 12 digits beside a sign, a point, and an exponent of five characters.
TEST(RealText, TwentyCharactersKeepTwelveDigits)
{
  double x = 1. / 3;
  for (int i = 0; i < 300; ++i)
  {
    for (const double y : { x, -x, 1 / x, -1 / x })
    {
      const std::string text = realText(y, 20);
      EXPECT_LE(text.size(), 20U);
      EXPECT_NEAR(std::strtod(text.c_str(), nullptr) / y, 1, 1e-12) << text;
    }
    x *= 0.1234567;
  }
}

TEST(WriteThenRename, ReplacesTheFileAtTheEnd)
{
  const Folder folder;
  const std::string path = folder / "a.inp";
  std::ofstream(path) << "before";
  writeThenRename(path,
    [&](const std::string& temporary)
    {
      EXPECT_EQ(fs::path(temporary).extension(), ".inp");
      OutputFile file(temporary);
      file << "after " << 7 << ' ' << 0.5;
      EXPECT_EQ(contentOf(path), "before");
      file.close();
    });
  EXPECT_EQ(contentOf(path), "after 7 0.5");
  EXPECT_EQ(folder.files(), 1U);
}

TEST(WriteThenRename, LeavesNothingAfterAnError)
{
  const Folder folder;
  const auto fail = [](const std::string& temporary)
  {
    OutputFile file(temporary);
    file << "a part";
    throw Cancelled();
  };
  EXPECT_THROW(writeThenRename(folder / "a.inp", fail), Cancelled);
  EXPECT_EQ(folder.files(), 0U);
}

TEST(OutputFile, TellsWhichFileAndWhy)
{
  const Folder folder;
  try
  {
    writeThenRename(
      folder / "missing/a.inp", [](const std::string& path) { OutputFile file(path); });
    FAIL() << "a folder that is not there was written to";
  }
  catch (const WriteError& error)
  {
    const std::string text = error.what();
    EXPECT_EQ(text.find(".part"), std::string::npos) << text; // the name that the user knows
    EXPECT_NE(text.find("missing/a.inp: cannot be written: "), std::string::npos) << text;
  }
}

/// The device on which nothing has room.
TEST(OutputFile, TellsOfAFullDisk)
{
  if (!fs::exists("/dev/full"))
  {
    GTEST_SKIP() << "there is no /dev/full";
  }
  OutputFile file("/dev/full");
  file << "little"; // stays in the buffer
  EXPECT_THROW(file.close(), WriteError);
  OutputFile other("/dev/full");
  EXPECT_THROW(
    for (int i = 0; i < 100000; ++i) { other << "much more than a buffer"; }, WriteError);
}

} // namespace quadrille
