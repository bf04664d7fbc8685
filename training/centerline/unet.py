"""The network: a small U-Net that works at half resolution inside.

A strided 4x4 stem halves the page, a transposed 4x4 convolution brings the answer back to full
resolution; only operations that OpenCV's DNN module runs fast. At 1024x1024 it takes 35 GFLOP.
"""

from __future__ import annotations

from itertools import pairwise

import torch
from torch import Tensor, nn

WIDTHS = (24, 48, 96, 128)
STRIDE = 2 ** len(WIDTHS)  # both sides of an input are multiples of this
HEADS = ("centerline", "junctions", "endpoints", "half_width", "solid")
HEADS += ("doubled", "apart", "clean", "lifted")


class CenterlineNet(nn.Module):
    """(N, 1, H, W) ink in [0, 1] -> (N, 9, H, W) raw values, channels as in HEADS.

    widths: channels of the levels, from the finest to the coarsest. counts: 3x3 convolutions of
    each on the way down, without a choice one at the finest and two at the others; on the way up
    all have one. The finest level adds what comes from below, the others append it: half the work
    at the resolution that costs most. Without norms the convolutions have biases instead: what a
    network with norms is exported as.
    """

    def __init__(
        self,
        widths: tuple[int, ...] = WIDTHS,
        counts: tuple[int, ...] | None = None,
        norms: bool = True,
    ) -> None:
        super().__init__()

        def conv(
            inputs: int, outputs: int, kernel: int = 3, stride: int = 1, pad: int = 1
        ) -> nn.Module:
            return nn.Sequential(
                nn.Conv2d(inputs, outputs, kernel, stride, pad, bias=not norms),
                nn.BatchNorm2d(outputs) if norms else nn.Identity(),
                nn.ReLU(inplace=True),
            )

        pairs = list(pairwise(widths))
        counts = counts or (1, *[2] * len(pairs))
        self.stem = conv(1, widths[0], 4, 2, 1)
        self.encode = nn.ModuleList(
            nn.Sequential(*(conv(w, w) for _ in range(count)))
            for w, count in zip(widths, counts, strict=True)
        )
        self.down = nn.ModuleList(conv(a, b, 2, 2, 0) for a, b in pairs)
        self.up = nn.ModuleList(nn.ConvTranspose2d(b, a, 2, 2) for a, b in pairs)
        self.decode = nn.ModuleList(
            conv(w if finest else 2 * w, w)
            for w, finest in zip(widths, [True] + [False] * (len(pairs) - 1), strict=False)
        )
        self.head = nn.ConvTranspose2d(widths[0], len(HEADS), 4, 2, 1)
        # Most of a page is paper: start from "no line".
        nn.init.constant_(self.head.bias, -3.0)

    def features(self, ink: Tensor) -> Tensor:
        """(N, C, H / 2, W / 2): what all maps are made of; C = the first of the widths."""
        x = self.stem(ink)
        skips = []
        for encode, down in zip(self.encode, self.down, strict=False):
            x = encode(x)
            skips.append(x)
            x = down(x)
        x = self.encode[-1](x)
        for level in reversed(range(len(skips))):
            below = self.up[level](x)
            merged = torch.cat([skips[level], below], 1) if level else skips[0] + below
            x = self.decode[level](merged)
        return x

    def forward(self, ink: Tensor) -> Tensor:
        return self.head(self.features(ink))


class Exported(nn.Module):
    """The network with its final activation: all maps in [0, 1], and the features."""

    def __init__(self, net: CenterlineNet) -> None:
        super().__init__()
        self.net = net

    def forward(self, ink: Tensor) -> tuple[Tensor, Tensor]:
        features = self.net.features(ink)
        return self.net.head(features).sigmoid(), features
