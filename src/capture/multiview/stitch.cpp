// stitch.cpp - the one file that knows OpenCV: a module, opened by stitch_load.c
//
// Brown, Lowe 2007: SIFT features, pairs of pictures that a homography explains, one focal length
// and one rotation for each by bundle adjustment of rays, the horizon by the cameras' x axes. Pairs
// that contradict the others are left out before.
#include "capture/multiview/stitch.h"

#include <opencv2/calib3d.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/stitching/detail/matchers.hpp>
#include <opencv2/stitching/detail/motion_estimators.hpp>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <vector>

using namespace cv;
using namespace cv::detail;

namespace
{

const double feature_pixels = 0.8e6;  // pictures are looked at about this large
const float match_confidence = 0.3f, pair_confidence = 0.9f;
const double sure_confidence = 3.0;       // OpenCV's own highest
const double least_contradiction = 0.25;  // of a picture's width
const TermCriteria rounds(TermCriteria::COUNT + TermCriteria::EPS, 100, 1e-7);
const size_t text_size = 300;

relume_status refuse(char *why, const char *text)
{
    std::snprintf(why, text_size, "%s", text);
    return RELUME_EUNFIT;
}

std::vector<ImageFeatures> find_features(const stitch_picture *pictures, int n, double scale)
{
    const Ptr<SIFT> finder = SIFT::create(2000);
    std::vector<ImageFeatures> features(static_cast<size_t>(n));
    for (int i = 0; i < n; i++) {
        const stitch_picture &p = pictures[i];
        const Mat whole(p.height, p.width, CV_8UC1, const_cast<uint8_t *>(p.grey));
        Mat small;
        resize(whole, small, Size(), scale, scale, INTER_AREA);
        computeImageFeatures(finder, small, features[static_cast<size_t>(i)]);
        features[static_cast<size_t>(i)].img_idx = i;
    }
    return features;
}

// OpenCV leaves out pairs that are explained all too well; they are the best there are.
void count_sure(std::vector<MatchesInfo> &pairs)
{
    for (MatchesInfo &p : pairs)
        if (p.num_inliers > sure_confidence * (8.0 + 0.3 * static_cast<double>(p.matches.size())))
            p.confidence = sure_confidence;
}

// The first picture outside the largest group that hangs together; -1: none.
int stray_of(std::vector<ImageFeatures> features, std::vector<MatchesInfo> pairs, int n)
{
    const std::vector<int> kept = leaveBiggestComponent(features, pairs, pair_confidence);
    for (int i = 0; i < n; i++)
        if (std::find(kept.begin(), kept.end(), i) == kept.end())
            return i;
    return -1;
}

Vec3d ray(const CameraParams &camera, Point2f at)
{
    const Vec3d inside(at.x - camera.ppx, at.y - camera.ppy, camera.focal);
    return Matx33d(Mat_<double>(camera.R)) * (inside / norm(inside));
}

// How far from each other two cameras see what they have in common: the median, in radians.
double contradiction(const std::vector<CameraParams> &cameras,
                     const std::vector<ImageFeatures> &features, const MatchesInfo &pair)
{
    const size_t a = static_cast<size_t>(pair.src_img_idx);
    const size_t b = static_cast<size_t>(pair.dst_img_idx);
    std::vector<double> apart;
    for (size_t i = 0; i < pair.matches.size(); i++) {
        const size_t from = static_cast<size_t>(pair.matches[i].queryIdx);
        const size_t to = static_cast<size_t>(pair.matches[i].trainIdx);
        if (pair.inliers_mask[i])
            apart.push_back(norm(ray(cameras[a], features[a].keypoints[from].pt) -
                                 ray(cameras[b], features[b].keypoints[to].pt)));
    }
    if (apart.empty())
        return 0.0;
    std::nth_element(apart.begin(), apart.begin() + apart.size() / 2, apart.end());
    return apart[apart.size() / 2];
}

// Things that look alike elsewhere: one such pair would bend all. The first poses follow the pairs
// that have most in common.
void drop_contradicting(std::vector<MatchesInfo> &pairs, const std::vector<CameraParams> &cameras,
                        const std::vector<ImageFeatures> &features)
{
    for (MatchesInfo &p : pairs) {
        if (p.confidence <= pair_confidence)
            continue;
        const size_t a = static_cast<size_t>(p.src_img_idx);
        const double width = features[a].img_size.width / cameras[a].focal;
        if (contradiction(cameras, features, p) > least_contradiction * width)
            p.confidence = 0.0;
    }
}

bool adjust(std::vector<CameraParams> &cameras, const std::vector<ImageFeatures> &features,
            std::vector<MatchesInfo> &pairs)
{
    HomographyBasedEstimator estimate;
    if (!estimate(features, pairs, cameras))
        return false;
    drop_contradicting(pairs, cameras, features);
    for (CameraParams &c : cameras)
        c.R.convertTo(c.R, CV_32F);
    BundleAdjusterRay bundle;
    bundle.setConfThresh(pair_confidence);
    bundle.setTermCriteria(rounds);
    if (!bundle(features, pairs, cameras))
        return false;
    std::vector<Mat> rotations;
    for (const CameraParams &c : cameras)
        rotations.push_back(c.R.clone());
    waveCorrect(rotations, WAVE_CORRECT_HORIZ);
    for (size_t i = 0; i < cameras.size(); i++)
        cameras[i].R = rotations[i];
    return true;
}

// OpenCV's world has y down and z ahead, ours y up and z behind.
void hand_over(stitch_pose *out, const CameraParams &camera, double scale)
{
    const double sign[3] = {1.0, -1.0, -1.0};
    out->focal = camera.focal / scale;
    out->center[0] = (camera.ppx + 0.5) / scale - 0.5;
    out->center[1] = (camera.ppy + 0.5) / scale - 0.5;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            out->rotation[3 * i + k] = sign[i] * static_cast<double>(camera.R.at<float>(i, k));
}

relume_status find(stitch_pose *poses, int *stray, const stitch_picture *pictures, int n, char *why)
{
    const double pixels = static_cast<double>(pictures[0].width) * pictures[0].height;
    const double scale = std::min(1.0, std::sqrt(feature_pixels / pixels));
    const std::vector<ImageFeatures> features = find_features(pictures, n, scale);
    std::vector<MatchesInfo> pairs;
    BestOf2NearestMatcher match(false, match_confidence);
    match(features, pairs);
    match.collectGarbage();
    count_sure(pairs);
    *stray = stray_of(features, pairs, n);
    if (*stray >= 0)
        return refuse(why, "overlaps none of the others");
    std::vector<CameraParams> cameras;
    if (!adjust(cameras, features, pairs))
        return refuse(why, "no rotations explain what the photographs have in common; expected a "
                           "camera that turns about one point");
    for (int i = 0; i < n; i++)
        hand_over(&poses[i], cameras[static_cast<size_t>(i)], scale);
    return RELUME_OK;
}

relume_status find_or_catch(stitch_pose *poses, int *stray, char *why,
                            const stitch_picture *pictures, int n)
{
    *stray = -1;
    try {
        setNumThreads(1);  // the same poses on every machine
        setRNGSeed(1);
        return find(poses, stray, pictures, n, why);
    } catch (const std::bad_alloc &) {
        return RELUME_ENOMEM;
    } catch (const std::exception &e) {
        return refuse(why, e.what());
    }
}

}  // namespace

extern "C" RELUME_API const stitch_bridge relume_stitch_bridge;
const stitch_bridge relume_stitch_bridge = {RELUME_VERSION, find_or_catch};
