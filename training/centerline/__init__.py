"""The centerline network: pages drawn from true strokes, training, validation, export.

geometry -> media -> paper -> sample     one synthetic page with its targets
data -> train -> validate -> export      from pages to engine/weights/centerline.onnx
"""
