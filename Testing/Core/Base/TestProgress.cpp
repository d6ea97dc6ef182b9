// SPDX-FileCopyrightText: The Quadrille maintainers
// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Progress.h"

#include <gtest/gtest.h>

namespace quadrille
{

TEST(Progress, anEmptyCallbackNeverCancels)
{
  EXPECT_NO_THROW(report({}, 0.5, "half"));
}

TEST(Progress, theCallbackGetsFractionAndTextAndMayCancel)
{
  double fraction = 0;
  std::string text;
  const ProgressCallback go = [&](double f, const std::string& t)
  {
    fraction = f;
    text = t;
    return true;
  };
  report(go, 0.25, "quarter");
  EXPECT_EQ(fraction, 0.25);
  EXPECT_EQ(text, "quarter");
  EXPECT_THROW(report([](double, const std::string&) { return false; }, 0, ""), Cancelled);
}

TEST(Progress, aStatusIsOkUnlessToldOtherwise)
{
  EXPECT_TRUE(Status().ok());
  EXPECT_FALSE((Status{ StatusCode::Infeasible, "no" }.ok()));
}

} // namespace quadrille
