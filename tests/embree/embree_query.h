// Embree 4 or 3, whose calls that trace rays differ, by one name.
#pragma once
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace sundog {

/// How rays are traced; the results stand in the rays. Coherent: rays in a row run close together.
#if RTC_VERSION_MAJOR >= 4
class EmbreeQuery {
 public:
  explicit EmbreeQuery(bool coherent) {
    rtcInitIntersectArguments(&intersect_);
    rtcInitOccludedArguments(&occluded_);
    if (coherent) intersect_.flags = occluded_.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  }
  void intersect(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &ray, &intersect_); }
  void occluded(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &ray, &occluded_); }
  void intersect(RTCScene scene, const int* valid, RTCRayHit16& rays) {
    rtcIntersect16(valid, scene, &rays, &intersect_);
  }
  void occluded(RTCScene scene, const int* valid, RTCRay16& rays) {
    rtcOccluded16(valid, scene, &rays, &occluded_);
  }

 private:
  RTCIntersectArguments intersect_;
  RTCOccludedArguments occluded_;
};
#else
class EmbreeQuery {
 public:
  explicit EmbreeQuery(bool coherent) {
    rtcInitIntersectContext(&context_);
    if (coherent) context_.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  }
  void intersect(RTCScene scene, RTCRayHit& ray) { rtcIntersect1(scene, &context_, &ray); }
  void occluded(RTCScene scene, RTCRay& ray) { rtcOccluded1(scene, &context_, &ray); }
  void intersect(RTCScene scene, const int* valid, RTCRayHit16& rays) {
    rtcIntersect16(valid, scene, &context_, &rays);
  }
  void occluded(RTCScene scene, const int* valid, RTCRay16& rays) {
    rtcOccluded16(valid, scene, &context_, &rays);
  }

 private:
  RTCIntersectContext context_;
};
#endif

}  // namespace sundog
