"""The network: a small U-Net that works at half resolution inside.

A strided 4x4 stem halves the page, a transposed 4x4 convolution brings the answer back to full
resolution; only operations that OpenCV's DNN module runs fast. At 1024x1024 it takes 70 GFLOP.
"""

from __future__ import annotations

from itertools import pairwise

import torch
from torch import Tensor, nn

WIDTHS = (32, 64, 128, 192)
STRIDE = 2 ** len(WIDTHS)  # both sides of an input are multiples of this
HEADS = ("centerline", "junctions", "endpoints", "half_width", "solid")


class CenterlineNet(nn.Module):
    """(N, 1, H, W) ink in [0, 1] -> (N, 5, H, W) raw values, channels as in HEADS.

    Without norms the convolutions have biases instead: what a network with norms is exported as.
    """

    def __init__(self, widths: tuple[int, ...] = WIDTHS, norms: bool = True) -> None:
        super().__init__()

        def conv(
            inputs: int, outputs: int, kernel: int = 3, stride: int = 1, pad: int = 1
        ) -> nn.Module:
            return nn.Sequential(
                nn.Conv2d(inputs, outputs, kernel, stride, pad, bias=not norms),
                nn.BatchNorm2d(outputs) if norms else nn.Identity(),
                nn.ReLU(inplace=True),
            )

        def level(inputs: int, outputs: int) -> nn.Module:
            return nn.Sequential(conv(inputs, outputs), conv(outputs, outputs))

        pairs = list(pairwise(widths))
        self.stem = conv(1, widths[0], 4, 2, 1)
        self.encode = nn.ModuleList(level(w, w) for w in widths)
        self.down = nn.ModuleList(conv(a, b, 2, 2, 0) for a, b in pairs)
        self.up = nn.ModuleList(nn.ConvTranspose2d(b, a, 2, 2) for a, b in pairs)
        self.decode = nn.ModuleList(level(2 * w, w) for w in widths[:-1])
        self.head = nn.ConvTranspose2d(widths[0], len(HEADS), 4, 2, 1)
        # Most of a page is paper: start from "no line".
        nn.init.constant_(self.head.bias, -3.0)

    def forward(self, ink: Tensor) -> Tensor:
        x = self.stem(ink)
        skips = []
        for encode, down in zip(self.encode, [*self.down, None], strict=True):
            x = encode(x)
            if down is not None:
                skips.append(x)
                x = down(x)
        for skip, up, decode in reversed(list(zip(skips, self.up, self.decode, strict=True))):
            x = decode(torch.cat([skip, up(x)], 1))
        return self.head(x)


class Exported(nn.Module):
    """The network with its final activation: all maps in [0, 1]."""

    def __init__(self, net: CenterlineNet) -> None:
        super().__init__()
        self.net = net

    def forward(self, ink: Tensor) -> Tensor:
        return self.net(ink).sigmoid()
