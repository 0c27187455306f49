#pragma once

/// The coefficients of the sky model of Lukas Hosek and Alexander Wilkie ("An Analytic Model for
/// Full Spectral Sky-Dome Radiance", 2012), version 1.4a: by albedo (0, 1), turbidity (1 to 10) and
/// Bézier point of the sun's elevation. Their data set comes under the following licence.
///
/// This source is published under the following 3-clause BSD license.
///
/// Copyright (c) 2012 - 2013, Lukas Hosek and Alexander Wilkie
/// All rights reserved.
///
/// Redistribution and use in source and binary forms, with or without modification, are permitted
/// provided that the following conditions are met:
///
///     * Redistributions of source code must retain the above copyright notice, this list of
///       conditions and the following disclaimer.
///     * Redistributions in binary form must reproduce the above copyright notice, this list of
///       conditions and the following disclaimer in the documentation and/or other materials
///       provided with the distribution.
///     * None of the names of the contributors may be used to endorse or promote products derived
///       from this software without specific prior written permission.
///
/// THIS SOFTWARE IS PROVIDED BY THE COPYRIGHT HOLDERS AND CONTRIBUTORS "AS IS" AND ANY EXPRESS OR
/// IMPLIED WARRANTIES, INCLUDING, BUT NOT LIMITED TO, THE IMPLIED WARRANTIES OF MERCHANTABILITY AND
/// FITNESS FOR A PARTICULAR PURPOSE ARE DISCLAIMED. IN NO EVENT SHALL THE COPYRIGHT HOLDERS BE
/// LIABLE FOR ANY DIRECT, INDIRECT, INCIDENTAL, SPECIAL, EXEMPLARY, OR CONSEQUENTIAL DAMAGES
/// (INCLUDING, BUT NOT LIMITED TO, PROCUREMENT OF SUBSTITUTE GOODS OR SERVICES; LOSS OF USE, DATA,
/// OR PROFITS; OR BUSINESS INTERRUPTION) HOWEVER CAUSED AND ON ANY THEORY OF LIABILITY, WHETHER IN
/// CONTRACT, STRICT LIABILITY, OR TORT (INCLUDING NEGLIGENCE OR OTHERWISE) ARISING IN ANY WAY OUT
/// OF THE USE OF THIS SOFTWARE, EVEN IF ADVISED OF THE POSSIBILITY OF SUCH DAMAGE.
namespace komorebi {

extern const double kHosekDistributionX[2][10][6][9];
extern const double kHosekDistributionY[2][10][6][9];
extern const double kHosekDistributionZ[2][10][6][9];
extern const double kHosekRadianceX[2][10][6];
extern const double kHosekRadianceY[2][10][6];
extern const double kHosekRadianceZ[2][10][6];

}  // namespace komorebi
