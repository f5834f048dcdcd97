// Oracle: pictures made by hand.
#include "bench/check.h"

#include <stdexcept>

#include <gtest/gtest.h>

namespace gnomon::bench {
namespace {

Subject subject_of(Kind kind) {
  Subject subject{.name = "hand", .kind = kind, .size = {100, 100}};
  return subject;
}

const Task kTask{System::llvmpipe, Method::zfail, 1};

TEST(Agreement, CountsShadowAndNotWhatIsSeen) {
  const Agreement agreement =
      compare(subject_of(Kind::shadows), kTask, {0, 1, 2, 2, 1}, {1, 0, 2, 1, 2});
  EXPECT_EQ(agreement.differing, 2u);
  EXPECT_EQ(agreement.pixels, 5u);
  EXPECT_EQ(agreement.gnomon_share, 0.4);
  EXPECT_EQ(agreement.share, 0.4);
}

TEST(Agreement, CountsEveryOtherValueOfADepthOrACount) {
  EXPECT_EQ(compare(subject_of(Kind::layer), kTask, {0, 1, 2}, {0, 2, 1}).differing, 2u);
  EXPECT_EQ(compare(subject_of(Kind::depth), kTask, {9, 255, 3}, {8, 255, 3}).differing, 1u);
}

TEST(Agreement, RefusesPicturesOfOtherSizes) {
  EXPECT_THROW(compare(subject_of(Kind::layer), kTask, {1, 2}, {1}), std::runtime_error);
}

TEST(Agreement, AdmitsAnOutlineAndRefusesAHole) {
  const Subject subject = subject_of(Kind::shadows);
  Picture own(100 * 100, 1), other = own;
  for (std::size_t i = 0; i < 5000; ++i) own[i] = other[i] = 2;
  // Ten of ten thousand pixels, as many to one side as to the other.
  for (std::size_t i = 0; i < 5; ++i) {
    other[i] = 1;
    other[9999 - i] = 2;
  }
  EXPECT_NO_THROW(require_agreement(compare(subject, kTask, own, other)));
  other[5] = 1;
  EXPECT_THROW(require_agreement(compare(subject, kTask, own, other)), std::runtime_error);
}

TEST(Agreement, RefusesAShadowThatOnlyGrew) {
  Picture own(100 * 100, 1), other = own;
  for (std::size_t i = 0; i < 6; ++i) other[i] = 2;
  EXPECT_THROW(require_agreement(compare(subject_of(Kind::shadows), kTask, own, other)),
               std::runtime_error);
}

}  // namespace
}  // namespace gnomon::bench
