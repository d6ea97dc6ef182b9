// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Export/SetNames.h"

#include <gtest/gtest.h>

namespace quadrille
{

using Names = std::vector<std::string>;

TEST(SetNames, GoodNamesStay)
{
  SetNames names(kInpNames);
  EXPECT_EQ(names.unique({ "INLET", "PATCH_1", "A1_B" }), (Names{ "INLET", "PATCH_1", "A1_B" }));
  EXPECT_TRUE(names.notices().empty());
}

TEST(SetNames, IdentifiersHaveLettersDigitsAndUnderscores)
{
  SetNames names(kInpNames);
  EXPECT_EQ(names.unique({ "inlet pipe", "a,b*c", "7up",
              "Gr\xC3\xB6\xC3\x9F"
              "e",
              "  ", "_x" }),
    (Names{ "INLET_PIPE", "A_B_C", "S_7UP", "GR__E", "S_", "S__X" }));
  EXPECT_NE(
    names.notices().at(0).find("6 names of sets are another in this format"), std::string::npos);
}

/// Case alone is no change where it does not count, but makes two names one.
TEST(SetNames, CaseDoesNotCountInDecks)
{
  SetNames names(kInpNames);
  EXPECT_EQ(names.unique({ "Wall" }), Names{ "WALL" });
  EXPECT_TRUE(names.notices().empty());
  EXPECT_EQ(names.unique({ "wAll" }), Names{ "WALL_2" });
  EXPECT_FALSE(names.notices().empty());
}

/// A name that needs no change keeps it, wherever it stands.
TEST(SetNames, NamesThatFitGoFirst)
{
  SetNames names(kInpNames);
  EXPECT_EQ(names.unique({ "A B", "A_B", "A,B" }), (Names{ "A_B_2", "A_B", "A_B_3" }));
}

TEST(SetNames, LongNamesAreCutBetweenCharacters)
{
  SetNames names(kExodusNames);
  const std::string umlauts =
    "\xC3\xB6\xC3\xB6\xC3\xB6\xC3\xB6\xC3\xB6\xC3\xB6\xC3\xB6\xC3\xB6"
    "\xC3\xB6\xC3\xB6\xC3\xB6\xC3\xB6\xC3\xB6\xC3\xB6\xC3\xB6\xC3\xB6\xC3\xB6"; // 17, 34 bytes
  const Names found = names.unique({ "x" + umlauts, "x" + umlauts + "y" });
  EXPECT_EQ(found[0], "x" + umlauts.substr(0, 30));        // 31 bytes: the next character has two
  EXPECT_EQ(found[1], "x" + umlauts.substr(0, 28) + "_2"); // the same with two bytes less
  EXPECT_LE(found[1].size(), 32U);
}

TEST(SetNames, RoomIsLeftForWhatComesBehind)
{
  SetNames names(kInpNames);
  EXPECT_EQ(names.unique({ std::string(200, 'a') }, 6)[0].size(), 74U);
}

TEST(SetNames, OtherFormatsKeepLettersAndBlanks)
{
  SetNames gmsh(kGmshNames);
  EXPECT_EQ(gmsh.unique({ "inlet pipe",
              "Gr\xC3\xB6\xC3\x9F"
              "e",
              "a\"b", "a\nb" }),
    (Names{ "inlet pipe",
      "Gr\xC3\xB6\xC3\x9F"
      "e",
      "a'b", "a b" }));
  SetNames obj(kObjNames);
  EXPECT_EQ(obj.unique({ "inlet pipe" }), Names{ "inlet_pipe" });
}

} // namespace quadrille
