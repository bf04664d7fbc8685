"""The centerline network: pages drawn from true strokes, training, validation, export.

synthesis -> targets -> training_page                          one page with its targets
page_batches -> train_centerline -> validate -> export_centerline   from pages to the weights
"""
